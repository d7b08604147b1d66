#include "io/exr/exr_deep_part.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "io/exr/exr_common.h"
#include "io/exr/part_readers.h"
#include "io/files/memory_limit.h"

#include <ImfDeepFrameBuffer.h>
#include <ImfDeepTiledInputPart.h>
#include <ImfPartType.h>
#include <fmt/format.h>

#include <atomic>
#include <numeric>
#include <utility>

namespace sparselens {

namespace {

// The memory into which each channel of a file is read. Channels that are not listed are not read.
struct Planes {
    std::vector<std::pair<std::string, std::vector<float> *>> named;
    std::vector<PixelType> types;
    void add(const std::string &name, std::vector<float> &values, PixelType type) {
        named.emplace_back(name, &values);
        types.push_back(type);
    }
};

// The array of the LDI that a channel fills because of its name, or null.
std::vector<float> *placement_array(Ldi &ldi, const std::string &name, const std::string &depth) {
    if (name == depth) return &ldi.z;
    if (lower_case(name) == lower_case(depth) + "back") return &ldi.z_back; // ZBack, depth.ZBack
    if (name == "ldi.dx") return &ldi.dx;
    if (name == "ldi.dy") return &ldi.dy;
    if (name == "ldi.optical") return &ldi.image_z;
    if (name == "ldi.solid") return &ldi.solid;
    return name == "ldi.weight" ? &ldi.weight : nullptr;
}

// Sets ldi.channels to the channels that are kept as values.
Planes plan_planes(Ldi &ldi, const std::vector<FileChannel> &found, const std::string &depth) {
    Planes planes;
    std::vector<std::string> carried;
    for (const auto &[in_file, channel, kept] : found)
        if (std::vector<float> *array = placement_array(ldi, channel.name, depth)) {
            planes.add(in_file, *array, PixelType::float32);
        } else if (!is_position_channel(channel.name)) {
            ldi.channels.push_back(channel);
            carried.push_back(in_file);
        }
    ldi.values.resize(ldi.channels.size());
    for (std::size_t k = 0; k < ldi.channels.size(); ++k)
        planes.add(carried[k], ldi.values[k], ldi.channels[k].type);
    return planes;
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
        const std::size_t first = w.index(Imath::V2i(w.data.min.x, first_row));
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

void check_room(const Ldi &ldi, std::size_t planes, const DeepSource &source) {
    const double counts = double(ldi.begin.size()) * sizeof(ldi.begin[0]);
    const double bytes = double(ldi.begin.back()) * double(planes * sizeof(float));
    check_memory(source.path, source.held + counts + bytes, source.size);
}

void make_room(const Ldi &ldi, const Planes &planes, const DeepSource &source) {
    check_room(ldi, planes.named.size(), source);
    parallel_for(planes.named.size(),
                 [&](std::size_t k) { planes.named[k].second->resize(ldi.begin.back()); });
}

// OpenEXR allocates what a chunk claims before it finds that the file is not that long. If it is asked for the raw
// bytes of a chunk without a buffer, it only returns their number.
template <typename RawSize>
void check_chunk(const DeepSource &source, const RawSize &raw_size) {
    std::uint64_t bytes = 0;
    raw_size(bytes);
    if (bytes > source.size)
        throw Error(fmt::format("{}: a chunk claims {} bytes, more than the file has",
                                display_name(source.path), bytes));
}

// Calls visit(part, first row, last row) for all rows, on all threads.
template <typename Visit>
void for_some_rows(const Ldi &ldi, PartReaders &readers, const Visit &visit) {
    const auto make = [&](Imf::DeepScanLineInputPart &part, int first, int last) {
        visit(part, first, last);
        return true;
    };
    for_some_rows(ldi.windows.data, readers, make, [](bool) {});
}

std::vector<unsigned> read_counts(PartReaders &readers, const DeepSource &source, Ldi &ldi) {
    std::vector<unsigned> counts(ldi.windows.pixels());
    Imf::DeepFrameBuffer only_counts;
    only_counts.insertSampleCountSlice(counts_slice(counts, ldi.windows));
    for_some_rows(ldi, readers, [&](Imf::DeepScanLineInputPart &part, int first, int last) {
        part.setFrameBuffer(only_counts);
        part.readPixelSampleCounts(first, last);
        for (int y = first; y <= last; ++y)
            check_chunk(source, [&](std::uint64_t &bytes) { part.rawPixelData(y, nullptr, bytes); });
    });
    set_counts(ldi, counts);
    return counts;
}

// `counts`: for the data window of `ldi`.
void read_rows(Imf::DeepScanLineInputPart &part, const Ldi &ldi, const Planes &planes, int first, int last,
               std::vector<unsigned> &counts) {
    const PointerTable table(ldi, planes, first, last, counts);
    part.setFrameBuffer(table.frame_buffer());
    part.readPixelSampleCounts(first, last); // a new frame buffer forgets the counts
    part.readPixels(first, last);
}

void read_scanlines(const DeepSource &source, int number, Ldi &ldi, const Planes &planes) {
    PartReaders readers(source.stream, number);
    std::vector<unsigned> counts = read_counts(readers, source, ldi);
    make_room(ldi, planes, source);
    for_some_rows(ldi, readers, [&](Imf::DeepScanLineInputPart &part, int first, int last) {
        read_rows(part, ldi, planes, first, last, counts);
    });
}

// Rows [first, last] of a picture; `counts`: for the whole picture.
Ldi some_rows(Imf::DeepScanLineInputPart &part, const DeepSource &source, const Windows &windows,
              const std::vector<unsigned> &counts, const std::vector<FileChannel> &channels,
              const std::string &depth, int first, int last) {
    Ldi rows;
    rows.windows = windows;
    rows.windows.data.min.y = first;
    rows.windows.data.max.y = last;
    const Planes planes = plan_planes(rows, channels, depth);
    const auto begin = counts.begin() + std::ptrdiff_t(windows.index(Imath::V2i(windows.data.min.x, first)));
    std::vector<unsigned> here(begin, begin + std::ptrdiff_t(rows.windows.pixels()));
    set_counts(rows, here);
    make_room(rows, planes, source);
    read_rows(part, rows, planes, first, last, here);
    return rows;
}

// Reserves room for as many samples as the file has; it takes no memory before it is used.
void append_rows(Ldi &ldi, Ldi rows, std::uint64_t most) {
    ldi.channels = rows.channels;
    ldi.values.resize(rows.values.size());
    const std::uint64_t before = ldi.begin.back();
    for (std::size_t pixel = 0; pixel + 1 < rows.begin.size(); ++pixel)
        ldi.begin.push_back(before + rows.begin[pixel + 1]);
    const std::vector<std::vector<float> *> to = arrays_of(ldi), from = arrays_of(rows);
    parallel_for(to.size(), [&](std::size_t k) {
        if (!from[k]->empty()) to[k]->reserve(most);
        to[k]->insert(to[k]->end(), from[k]->begin(), from[k]->end());
    });
}

// Keeps rows of a deep part that are read one after the other: as samples, or packed if they are many.
class KeptRows {
public:
    // `most`: the number of samples in the file.
    KeptRows(Ldi &ldi, std::uint64_t most, std::optional<PackedRows> &packed)
        : ldi_(ldi), most_(most), packed_(packed) {
        ldi.begin.assign(1, 0);
        ldi.begin.reserve(ldi.windows.pixels() + 1);
    }
    void add(Ldi rows) {
        if (packed_) return packed_->append(rows);
        append_rows(ldi_, std::move(rows), most_);
        if (bytes_to_gather(ldi_.samples(), ldi_.channels) <= memory_to_gather(most_, ldi_.windows.pixels()))
            return;
        packed_.emplace(ldi_.windows);
        packed_->append(ldi_);
        drop();
    }
    void drop() { // all rows of the LDI
        for (std::vector<float> *array : arrays_of(ldi_)) std::vector<float>().swap(*array);
        ldi_.begin.assign(ldi_.windows.pixels() + 1, 0);
    }

private:
    Ldi &ldi_;
    std::uint64_t most_;
    std::optional<PackedRows> &packed_;
};

// `ldi` has its windows; this fills the rest.
void read_reduced(const DeepSource &source, int number, Ldi &ldi, const std::vector<FileChannel> &channels,
                  const std::string &depth, const ReduceRows &reduce, std::optional<PackedRows> &packed) {
    PartReaders readers(source.stream, number);
    const std::vector<unsigned> counts = read_counts(readers, source, ldi);
    check_room(ldi, channels.size(), source);
    const Windows windows = ldi.windows;
    KeptRows kept(ldi, ldi.begin.back(), packed);
    std::atomic<bool> stopped = false;
    for_some_rows(
        windows.data, readers,
        [&](Imf::DeepScanLineInputPart &part, int first, int last) -> std::optional<Ldi> {
            if (stopped) return {};
            auto rows = reduce(some_rows(part, source, windows, counts, channels, depth, first, last));
            if (!rows) stopped = true;
            return rows;
        },
        [&](std::optional<Ldi> rows) {
            if (rows && !stopped) kept.add(std::move(*rows));
        });
    if (stopped) kept.drop();
}

void read_tiles(const DeepSource &source, int number, Ldi &ldi, const Planes &planes) {
    Imf::DeepTiledInputPart part(source.file, number);
    const Windows &w = ldi.windows;
    const int right = part.numXTiles(0) - 1, bottom = part.numYTiles(0) - 1;
    std::vector<unsigned> counts(w.pixels());
    Imf::DeepFrameBuffer only_counts;
    only_counts.insertSampleCountSlice(counts_slice(counts, w));
    part.setFrameBuffer(only_counts);
    part.readPixelSampleCounts(0, right, 0, bottom);
    set_counts(ldi, counts);
    make_room(ldi, planes, source);
    for (int ty = 0; ty <= bottom; ++ty)
        for (int tx = 0; tx <= right; ++tx)
            check_chunk(source, [&](std::uint64_t &bytes) {
                int x = tx, y = ty, level_x = 0, level_y = 0;
                part.rawTileData(x, y, level_x, level_y, nullptr, bytes);
            });
    const PointerTable table(ldi, planes, w.data.min.y, w.data.max.y, counts);
    part.setFrameBuffer(table.frame_buffer());
    part.readPixelSampleCounts(0, right, 0, bottom);
    part.readTiles(0, right, 0, bottom);
}

} // namespace

Ldi read_deep_part(const DeepSource &source, int number, const std::vector<FileChannel> &channels,
                   const std::string &depth, const ReduceRows &reduce, std::optional<PackedRows> &packed) {
    const Imf::Header &header = source.file.header(number);
    Ldi ldi;
    ldi.windows = windows_of(header);
    const Planes planes = plan_planes(ldi, channels, depth);
    const bool tiled = header.type() == Imf::DEEPTILE;
    constexpr std::size_t counts = 3; // in floats: a count, and where its samples begin
    const std::size_t pointers = tiled ? 2 * planes.named.size() : 0; // few rows at a time need little
    check_memory(source.path, source.held + memory_of(header, counts + pointers), source.size);
    if (reduce)
        read_reduced(source, number, ldi, channels, depth, reduce, packed);
    else if (tiled)
        read_tiles(source, number, ldi, planes);
    else
        read_scanlines(source, number, ldi, planes);
    return ldi;
}

Ldi ldi_of_flat(const Image &image, const std::string &depth) {
    Ldi ldi;
    ldi.windows = image.windows;
    std::vector<FileChannel> channels;
    for (const Channel &channel : image.channels) channels.push_back({channel.name, channel});
    const Planes planes = plan_planes(ldi, channels, depth);
    ldi.begin.resize(image.windows.pixels() + 1);
    std::iota(ldi.begin.begin(), ldi.begin.end(), std::uint64_t{0});
    for (const auto &[name, values] : planes.named) {
        const auto plane = image.plane(find_channel(image.channels, name));
        values->assign(plane.begin(), plane.end());
    }
    return ldi;
}

} // namespace sparselens
