#include "base/parallel.h"
#include "deep/order.h"
#include "io/exr/exr_common.h"
#include "io/exr/exr_deep.h"
#include "io/exr/kept_names.h"

#include <ImfDeepFrameBuffer.h>
#include <ImfDeepImageStateAttribute.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <numeric>

namespace sparselens {

namespace {

Imf::DeepImageState state_of(const Ldi &ldi) {
    const Order order = order_of(ldi);
    if (order.sorted) return order.apart ? Imf::DIS_TIDY : Imf::DIS_SORTED;
    return order.apart ? Imf::DIS_NON_OVERLAPPING : Imf::DIS_MESSY;
}

struct StoredChannel {
    std::string name;
    PixelType type;
    const std::vector<float> *values;
};

std::vector<StoredChannel> stored_channels(const Ldi &ldi, const Imf::Header &metadata) {
    std::vector<StoredChannel> stored{{"Z", PixelType::float32, &ldi.z}};
    const auto add = [&](const char *name, PixelType type, const std::vector<float> &values) {
        if (!values.empty()) stored.push_back({name, type, &values});
    };
    add("ZBack", PixelType::float32, ldi.z_back);
    add("ldi.dx", PixelType::half, ldi.dx);
    add("ldi.dy", PixelType::half, ldi.dy);
    add("ldi.weight", PixelType::half, ldi.weight);
    add("ldi.optical", PixelType::float32, ldi.optical);
    add("ldi.solid", PixelType::half, ldi.solid);
    const std::vector<Channel> named = by_kept_names(ldi.channels, metadata);
    for (std::size_t k = 0; k < named.size(); ++k)
        stored.push_back({named[k].name, named[k].type, &ldi.values[k]});
    return stored;
}

// Writes `rows` rows from `first_row` on: converts samples to the channels' types, then compresses them in parallel.
// Returns how many values store() clamped.
std::size_t write_rows(Imf::DeepScanLineOutputFile &file, const Ldi &ldi,
                       const std::vector<StoredChannel> &stored, int first_row, int rows) {
    const Windows &w = ldi.windows;
    const std::size_t width = std::size_t(w.width()), pixels = std::size_t(rows) * width;
    const std::size_t first = w.index(w.data.min.x, first_row);
    const std::uint64_t from = ldi.begin[first], count = ldi.begin[first + pixels] - from;
    const Imath::Box2i box({w.data.min.x, first_row}, {w.data.max.x, first_row + rows - 1});
    std::vector<unsigned> counts(pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        counts[i] = unsigned(ldi.begin[first + i + 1] - ldi.begin[first + i]);
    Imf::DeepFrameBuffer buffer;
    buffer.insertSampleCountSlice(
        Imf::Slice::Make(Imf::UINT, counts.data(), box, sizeof(unsigned), sizeof(unsigned) * width));
    std::vector<std::vector<char>> bytes(stored.size());
    std::vector<std::size_t> clamped(stored.size());
    std::vector<std::vector<char *>> pointers(stored.size());
    parallel_for(stored.size(), [&](std::size_t k) {
        const std::size_t size = bytes_of(stored[k].type);
        bytes[k].resize(count * size);
        clamped[k] = store(stored[k].type, stored[k].values->data() + from, count, bytes[k].data());
        pointers[k].resize(pixels);
        for (std::size_t i = 0; i < pixels; ++i)
            pointers[k][i] = bytes[k].data() + (ldi.begin[first + i] - from) * size;
    });
    for (std::size_t k = 0; k < stored.size(); ++k) {
        const auto type = imf_type(stored[k].type);
        const Imf::Slice base =
            Imf::Slice::Make(type, pointers[k].data(), box, sizeof(char *), sizeof(char *) * width);
        buffer.insert(stored[k].name,
                      Imf::DeepSlice(type, base.base, base.xStride, base.yStride, bytes_of(stored[k].type)));
    }
    file.setFrameBuffer(buffer);
    file.writePixels(rows);
    return std::accumulate(clamped.begin(), clamped.end(), std::size_t{0});
}

} // namespace

std::size_t write_ldi(const std::string &path, const Ldi &ldi, const Imf::Header &metadata,
                      std::optional<Imf::Compression> compression) {
    return with_file_name(path, [&] {
        const std::vector<StoredChannel> stored = stored_channels(ldi, metadata);
        std::vector<Channel> channels;
        for (const StoredChannel &channel : stored) channels.push_back({channel.name, channel.type});
        Imf::Header header = output_header(ldi.windows, channels, metadata);
        header.setType(Imf::DEEPSCANLINE);
        Imf::addDeepImageState(header, state_of(ldi));
        OutputFile output(path);
        header.compression() = output_compression(true, compression, output.to_pipe(), metadata, channels);
        std::size_t clamped = 0;
        {
            Imf::DeepScanLineOutputFile file(output.stream(), header);
            constexpr int rows_at_once = 128;
            const Imath::Box2i &data = ldi.windows.data;
            for (int y = data.min.y; y <= data.max.y; y += rows_at_once)
                clamped += write_rows(file, ldi, stored, y, std::min(rows_at_once, data.max.y - y + 1));
        }
        output.commit();
        return clamped;
    });
}

} // namespace sparselens
