#include "io/exr_deep.h"

#include "base/parallel.h"
#include "io/exr_common.h"
#include "io/exr_flat.h"

#include <ImfDeepFrameBuffer.h>
#include <ImfDeepImageStateAttribute.h>
#include <ImfDeepScanLineInputPart.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfDeepTiledInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <array>

namespace sparselens {

namespace {

// A file's channels sorted by what they are to an LDI.
struct Planes {
    std::vector<std::pair<std::string, std::vector<float> *>> named; // file channel -> where its values go
    std::vector<PixelType> types;
    void add(const std::string &name, std::vector<float> &values, PixelType type) {
        named.emplace_back(name, &values);
        types.push_back(type);
    }
};

constexpr std::array position_channels{"ldi.dx", "ldi.dy", "ldi.weight"};

// Back depth that goes with a front depth: "Z" -> "ZBack", "depth.Z" -> "depth.ZBack".
std::string back_of(const std::string &depth) { return depth + "Back"; }

// Sets ldi.channels to what is carried and lists where each channel of the file is to be read to.
Planes plan_planes(Ldi &ldi, const std::vector<Channel> &in_file, const std::string &depth) {
    Planes planes;
    const std::array<std::vector<float> *, 3> positions{&ldi.dx, &ldi.dy, &ldi.weight};
    std::vector<std::string> carried;
    for (const Channel &channel : in_file) {
        const auto position = std::find(position_channels.begin(), position_channels.end(), channel.name);
        if (channel.name == depth)
            planes.add(channel.name, ldi.z, PixelType::float32);
        else if (channel.name == back_of(depth))
            planes.add(channel.name, ldi.z_back, PixelType::float32);
        else if (position != position_channels.end())
            planes.add(channel.name, *positions[std::size_t(position - position_channels.begin())],
                       PixelType::float32);
        else
            ldi.channels.push_back(channel);
    }
    ldi.values.resize(ldi.channels.size());
    for (std::size_t k = 0; k < ldi.channels.size(); ++k)
        planes.add(ldi.channels[k].name, ldi.values[k], ldi.channels[k].type);
    return planes;
}

int first_deep_part(Imf::MultiPartInputFile &file) {
    for (int part = 0; part < file.parts(); ++part)
        if (file.header(part).hasType() && Imf::isDeepData(file.header(part).type())) return part;
    return -1;
}

Imf::Slice counts_slice(std::vector<unsigned> &counts, const Windows &w) {
    return Imf::Slice::Make(Imf::UINT, counts.data(), w.data, sizeof(unsigned),
                            sizeof(unsigned) * std::size_t(w.width()));
}

void set_counts(Ldi &ldi, const std::vector<unsigned> &counts) {
    ldi.begin.assign(counts.size() + 1, 0);
    for (std::size_t i = 0; i < counts.size(); ++i) ldi.begin[i + 1] = ldi.begin[i] + counts[i];
}

// For rows [first, last] of the data window: where each pixel's samples start in each plane.
class PointerTable {
public:
    PointerTable(const Ldi &ldi, const Planes &planes, int first_row, int last_row,
                 std::vector<unsigned> &counts) {
        const Windows &w = ldi.windows;
        const std::size_t width = std::size_t(w.width());
        const std::size_t first = std::size_t(first_row - w.data.min.y) * width;
        const std::size_t pixels = std::size_t(last_row - first_row + 1) * width;
        const Imath::Box2i rows({w.data.min.x, first_row}, {w.data.max.x, last_row});
        pointers_.resize(planes.named.size());
        buffer_.insertSampleCountSlice(counts_slice(counts, w));
        for (std::size_t k = 0; k < pointers_.size(); ++k) {
            pointers_[k].resize(pixels);
            for (std::size_t i = 0; i < pixels; ++i)
                pointers_[k][i] = planes.named[k].second->data() + ldi.begin[first + i];
            const auto type = planes.types[k] == PixelType::uint32 ? Imf::UINT : Imf::FLOAT;
            const Imf::Slice base =
                Imf::Slice::Make(type, pointers_[k].data(), rows, sizeof(float *), sizeof(float *) * width);
            buffer_.insert(planes.named[k].first,
                           Imf::DeepSlice(type, base.base, base.xStride, base.yStride, sizeof(float)));
        }
    }
    const Imf::DeepFrameBuffer &frame_buffer() const { return buffer_; }

private:
    std::vector<std::vector<float *>> pointers_;
    Imf::DeepFrameBuffer buffer_;
};

void make_room(const Ldi &ldi, const Planes &planes) {
    for (const auto &[name, values] : planes.named) values->resize(ldi.begin.back());
}

void read_scanlines(Imf::MultiPartInputFile &file, int number, Ldi &ldi, const Planes &planes) {
    Imf::DeepScanLineInputPart part(file, number);
    const Windows &w = ldi.windows;
    std::vector<unsigned> counts(w.pixels());
    Imf::DeepFrameBuffer only_counts;
    only_counts.insertSampleCountSlice(counts_slice(counts, w));
    part.setFrameBuffer(only_counts);
    part.readPixelSampleCounts(w.data.min.y, w.data.max.y);
    set_counts(ldi, counts);
    make_room(ldi, planes);
    constexpr int rows_at_once = 128; // bounds the pointer table, keeps all threads busy
    for (int y = w.data.min.y; y <= w.data.max.y; y += rows_at_once) {
        const int last = std::min(y + rows_at_once - 1, w.data.max.y);
        const PointerTable table(ldi, planes, y, last, counts);
        part.setFrameBuffer(table.frame_buffer());
        part.readPixelSampleCounts(y, last); // a new frame buffer forgets the counts
        part.readPixels(y, last);
    }
}

void read_tiles(Imf::MultiPartInputFile &file, int number, Ldi &ldi, const Planes &planes) {
    Imf::DeepTiledInputPart part(file, number);
    const Windows &w = ldi.windows;
    std::vector<unsigned> counts(w.pixels());
    Imf::DeepFrameBuffer only_counts;
    only_counts.insertSampleCountSlice(counts_slice(counts, w));
    part.setFrameBuffer(only_counts);
    const int right = part.numXTiles(0) - 1, bottom = part.numYTiles(0) - 1;
    part.readPixelSampleCounts(0, right, 0, bottom);
    set_counts(ldi, counts);
    make_room(ldi, planes);
    const PointerTable table(ldi, planes, w.data.min.y, w.data.max.y, counts);
    part.setFrameBuffer(table.frame_buffer());
    part.readPixelSampleCounts(0, right, 0, bottom);
    part.readTiles(0, right, 0, bottom);
}

Ldi ldi_of_flat(const Image &image, const std::string &depth) {
    Ldi ldi;
    ldi.windows = image.windows;
    const Planes planes = plan_planes(ldi, image.channels, depth);
    const std::size_t alpha = find_channel(image.channels, "A");
    ldi.begin.assign(image.windows.pixels() + 1, 0);
    for (std::size_t i = 0; i < image.windows.pixels(); ++i)
        ldi.begin[i + 1] = ldi.begin[i] + (alpha == npos || image.plane(alpha)[i] != 0 ? 1 : 0);
    make_room(ldi, planes);
    for (const auto &[name, values] : planes.named) {
        const auto plane = image.plane(find_channel(image.channels, name));
        for (std::size_t i = 0; i < plane.size(); ++i)
            if (ldi.begin[i] != ldi.begin[i + 1]) (*values)[ldi.begin[i]] = plane[i];
    }
    return ldi;
}

// TIDY: sorted, no two samples of a pixel overlap or share a depth.
Imf::DeepImageState state_of(const Ldi &ldi) {
    bool sorted = true, apart = true;
    const auto back = [&](std::uint64_t i) { return ldi.z_back.empty() ? ldi.z[i] : ldi.z_back[i]; };
    for (std::size_t pixel = 0; pixel + 1 < ldi.begin.size(); ++pixel)
        for (std::uint64_t i = ldi.begin[pixel] + 1; i < ldi.begin[pixel + 1]; ++i) {
            sorted = sorted && ldi.z[i - 1] <= ldi.z[i];
            const bool volume = back(i - 1) > ldi.z[i - 1];
            apart = apart && (volume ? back(i - 1) <= ldi.z[i] : ldi.z[i - 1] < ldi.z[i]);
        }
    if (sorted) return apart ? Imf::DIS_TIDY : Imf::DIS_SORTED;
    return apart ? Imf::DIS_NON_OVERLAPPING : Imf::DIS_MESSY;
}

struct StoredChannel {
    std::string name;
    PixelType type;
    const std::vector<float> *values;
};

std::vector<StoredChannel> stored_channels(const Ldi &ldi) {
    std::vector<StoredChannel> stored{{"Z", PixelType::float32, &ldi.z}};
    const auto add = [&](const char *name, PixelType type, const std::vector<float> &values) {
        if (!values.empty()) stored.push_back({name, type, &values});
    };
    add("ZBack", PixelType::float32, ldi.z_back);
    add("ldi.dx", PixelType::half, ldi.dx);
    add("ldi.dy", PixelType::half, ldi.dy);
    add("ldi.weight", PixelType::half, ldi.weight);
    for (std::size_t k = 0; k < ldi.channels.size(); ++k)
        stored.push_back({ldi.channels[k].name, ldi.channels[k].type, &ldi.values[k]});
    return stored;
}

// Writes `rows` rows from `first_row` on: samples turned into the channels' types, then compressed in parallel.
void write_rows(Imf::DeepScanLineOutputFile &file, const Ldi &ldi, const std::vector<StoredChannel> &stored,
                int first_row, int rows) {
    const Windows &w = ldi.windows;
    const std::size_t width = std::size_t(w.width()), pixels = std::size_t(rows) * width;
    const std::size_t first = std::size_t(first_row - w.data.min.y) * width;
    const std::uint64_t from = ldi.begin[first], count = ldi.begin[first + pixels] - from;
    const Imath::Box2i box({w.data.min.x, first_row}, {w.data.max.x, first_row + rows - 1});
    std::vector<unsigned> counts(pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        counts[i] = unsigned(ldi.begin[first + i + 1] - ldi.begin[first + i]);
    Imf::DeepFrameBuffer buffer;
    buffer.insertSampleCountSlice(
        Imf::Slice::Make(Imf::UINT, counts.data(), box, sizeof(unsigned), sizeof(unsigned) * width));
    std::vector<std::vector<char>> bytes(stored.size());
    std::vector<std::vector<char *>> pointers(stored.size());
    parallel_for(stored.size(), [&](std::size_t k) {
        const std::size_t size = bytes_of(stored[k].type);
        bytes[k].resize(count * size);
        store(stored[k].type, stored[k].values->data() + from, count, bytes[k].data());
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
}

} // namespace

LdiFile read_ldi(const std::string &path, const std::string &depth_channel) {
    return with_file_name(path, [&] {
        const auto stream = open_input(path);
        Imf::MultiPartInputFile file(*stream);
        const int number = first_deep_part(file);
        if (number < 0) {
            FlatFile flat = read_flat_part(file, path);
            const std::string depth = find_depth_channel(flat.image.channels, depth_channel, path);
            return LdiFile{ldi_of_flat(flat.image, depth), flat.header, false};
        }
        const Imf::Header &header = file.header(number);
        LdiFile result{{}, header, true};
        const std::vector<Channel> channels = channels_of(header, path);
        result.ldi.windows = windows_of(header);
        const Planes planes =
            plan_planes(result.ldi, channels, find_depth_channel(channels, depth_channel, path));
        if (header.type() == Imf::DEEPTILE)
            read_tiles(file, number, result.ldi, planes);
        else
            read_scanlines(file, number, result.ldi, planes);
        return result;
    });
}

void write_ldi(const std::string &path, const Ldi &ldi, const Imf::Header &metadata) {
    with_file_name(path, [&] {
        const std::vector<StoredChannel> stored = stored_channels(ldi);
        std::vector<Channel> channels;
        for (const StoredChannel &channel : stored) channels.push_back({channel.name, channel.type});
        Imf::Header header = output_header(ldi.windows, channels, metadata);
        header.setType(Imf::DEEPSCANLINE);
        header.compression() = Imf::ZIPS_COMPRESSION;
        Imf::addDeepImageState(header, state_of(ldi));
        OutputFile output(path);
        {
            Imf::DeepScanLineOutputFile file(output.stream(), header);
            constexpr int rows_at_once = 128;
            const Imath::Box2i &data = ldi.windows.data;
            for (int y = data.min.y; y <= data.max.y; y += rows_at_once)
                write_rows(file, ldi, stored, y, std::min(rows_at_once, data.max.y - y + 1));
        }
        output.commit();
    });
}

} // namespace sparselens
