#include "io/exr_common.h"
#include "io/exr_deep.h"
#include "io/exr_flat.h"
#include "io/exr_header_check.h"
#include "io/exr_parts.h"
#include "io/memory_limit.h"
#include "ldi/coloured_alpha.h"
#include "ldi/unite.h"

#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineInputPart.h>
#include <ImfDeepTiledInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>

#include <algorithm>
#include <numeric>

namespace sparselens {

namespace {

// Where each channel of a file is read to. What is not listed is not read.
struct Planes {
    std::vector<std::pair<std::string, std::vector<float> *>> named;
    std::vector<PixelType> types;
    void add(const std::string &name, std::vector<float> &values, PixelType type) {
        named.emplace_back(name, &values);
        types.push_back(type);
    }
};

// The array of the LDI that a channel fills because of its name, if it does.
std::vector<float> *placement_array(Ldi &ldi, const std::string &name, const std::string &depth) {
    if (name == depth) return &ldi.z;
    if (name == depth + "Back") return &ldi.z_back; // ZBack, depth.ZBack
    if (name == "ldi.dx") return &ldi.dx;
    if (name == "ldi.dy") return &ldi.dy;
    return name == "ldi.weight" ? &ldi.weight : nullptr;
}

// Sets ldi.channels to what is carried.
Planes plan_planes(Ldi &ldi, const std::vector<FileChannel> &found, const std::string &depth) {
    Planes planes;
    std::vector<std::string> carried;
    for (const auto &[in_file, channel] : found)
        if (std::vector<float> *array = placement_array(ldi, channel.name, depth)) {
            planes.add(in_file, *array, PixelType::float32);
        } else if (!is_placement(channel.name)) {
            ldi.channels.push_back(channel);
            carried.push_back(in_file);
        }
    ldi.values.resize(ldi.channels.size());
    for (std::size_t k = 0; k < ldi.channels.size(); ++k)
        planes.add(carried[k], ldi.values[k], ldi.channels[k].type);
    return planes;
}

std::vector<int> deep_parts(const Imf::MultiPartInputFile &file) {
    std::vector<int> numbers;
    for (int part = 0; part < file.parts(); ++part)
        if (file.header(part).hasType() && Imf::isDeepData(file.header(part).type())) numbers.push_back(part);
    return numbers;
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

// The file that is read; its size is what it may ask memory for.
struct Source {
    Imf::MultiPartInputFile &file;
    const std::string &path;
    std::uint64_t size;
    double held = 0; // bytes that what has been read of it takes
};

void make_room(const Ldi &ldi, const Planes &planes, const Source &source) {
    const double counts = double(ldi.begin.size()) * sizeof(ldi.begin[0]);
    const double bytes = double(ldi.begin.back()) * double(planes.named.size() * sizeof(float));
    check_memory(source.path, source.held + counts + bytes, source.size);
    for (const auto &[name, values] : planes.named) values->resize(ldi.begin.back());
}

// OpenEXR allocates what a chunk claims before it finds that the file is not that long. Asked for the raw bytes of a
// chunk without a place to put them, it only says how many there are.
template <typename RawSize>
void check_chunk(const Source &source, const RawSize &raw_size) {
    std::uint64_t bytes = 0;
    raw_size(bytes);
    if (bytes > source.size)
        throw Error(display_name(source.path) + ": a chunk claims " + std::to_string(bytes) +
                    " bytes, more than the file has");
}

void read_scanlines(const Source &source, int number, Ldi &ldi, const Planes &planes) {
    Imf::DeepScanLineInputPart part(source.file, number);
    const Windows &w = ldi.windows;
    std::vector<unsigned> counts(w.pixels());
    Imf::DeepFrameBuffer only_counts;
    only_counts.insertSampleCountSlice(counts_slice(counts, w));
    part.setFrameBuffer(only_counts);
    part.readPixelSampleCounts(w.data.min.y, w.data.max.y);
    set_counts(ldi, counts);
    make_room(ldi, planes, source);
    for (int y = w.data.min.y; y <= w.data.max.y; ++y)
        check_chunk(source, [&](std::uint64_t &bytes) { part.rawPixelData(y, nullptr, bytes); });
    constexpr int rows_at_once = 128; // bounds the pointer table, keeps all threads busy
    for (int y = w.data.min.y; y <= w.data.max.y; y += rows_at_once) {
        const int last = std::min(y + rows_at_once - 1, w.data.max.y);
        const PointerTable table(ldi, planes, y, last, counts);
        part.setFrameBuffer(table.frame_buffer());
        part.readPixelSampleCounts(y, last); // a new frame buffer forgets the counts
        part.readPixels(y, last);
    }
}

void read_tiles(const Source &source, int number, Ldi &ldi, const Planes &planes) {
    Imf::DeepTiledInputPart part(source.file, number);
    const Windows &w = ldi.windows;
    std::vector<unsigned> counts(w.pixels());
    Imf::DeepFrameBuffer only_counts;
    only_counts.insertSampleCountSlice(counts_slice(counts, w));
    part.setFrameBuffer(only_counts);
    const int right = part.numXTiles(0) - 1, bottom = part.numYTiles(0) - 1;
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

// `depth`: the part's depth channel; empty: it has none, and its samples lie nowhere.
Ldi read_part(const Source &source, int number, const std::vector<FileChannel> &channels,
              const std::string &depth) {
    const Imf::Header &header = source.file.header(number);
    Ldi ldi;
    ldi.windows = windows_of(header);
    const Planes planes = plan_planes(ldi, channels, depth);
    const bool tiled = header.type() == Imf::DEEPTILE;
    constexpr std::size_t counts = 3; // floats' worth: a count and where its samples begin
    const std::size_t pointers = tiled ? 2 * planes.named.size() : 0; // of scanlines a few rows at a time
    check_memory(source.path, source.held + memory_of(header, counts + pointers), source.size);
    if (tiled)
        read_tiles(source, number, ldi, planes);
    else
        read_scanlines(source, number, ldi, planes);
    return ldi;
}

double memory_held_by(const Ldi &ldi) {
    return double(ldi.begin.size()) * sizeof(ldi.begin[0]) +
           double(ldi.samples()) * double((ldi.values.size() + 5) * sizeof(float));
}

// The parts of one view as one picture, see read_ldi().
class DeepPicture {
public:
    DeepPicture(const Source &source, const std::string &view, const std::string &depth_channel)
        : source_(source), view_(view), asked_(depth_channel) {}

    void add(int number, bool only_as_layer) {
        const Imf::Header &header = source_.file.header(number);
        const std::vector<FileChannel> channels = channels_of(header, view_, source_.path);
        const std::string depth = depth_of(channels);
        Ldi part = read_part(source_, number, channels, depth);
        const auto whose = std::ranges::find_if(parts_, [&](const Ldi &other) {
            return depth.empty() ? part.windows == other.windows && part.begin == other.begin
                                 : same_samples(part, other);
        });
        const std::string name = layer_of(header);
        if (whose == parts_.end() && only_as_layer) {
            notes_.push_back("part " + name + " is left out: its samples are not the beauty's");
            return;
        }
        source_.held += memory_held_by(part);
        if (whose != parts_.end()) return add_layer(*whose, std::move(part), name);
        if (depth.empty())
            throw Error(display_name(source_.path) + ": part " + name +
                        " has no depth channel, and other samples than the parts before it");
        add_mean_coverage(part);
        parts_.push_back(std::move(part));
    }

    bool is_merged() const { return parts_.size() > 1; }

    Ldi whole() {
        if (!is_merged()) return std::move(parts_[0]);
        notes_.push_back(std::to_string(parts_.size()) + " deep parts are merged");
        Imath::Box2i data;
        for (const Ldi &part : parts_) data.extendBy(part.windows.data);
        Imf::Header all;
        all.dataWindow() = data;
        check_memory(source_.path, 2 * source_.held + memory_of(all, 2), source_.size);
        return united(parts_);
    }

    std::vector<std::string> notes() const { return notes_; }

private:
    // The first part must have one; those after it may be layers of it.
    std::string depth_of(const std::vector<FileChannel> &found) const {
        std::vector<Channel> channels;
        for (const FileChannel &channel : found) channels.push_back(channel.channel);
        const bool may_lack = !parts_.empty() && !has_depth_channel(channels, asked_);
        return may_lack ? "" : find_depth_channel(channels, asked_, source_.path);
    }

    Source source_;
    std::string view_, asked_;
    std::vector<Ldi> parts_;
    std::vector<std::string> notes_;
};

LdiFile read_flat_as_ldi(const Source &source, const std::string &depth_channel,
                         const std::string &stereo_view) {
    const std::string &path = source.path;
    FlatFile flat = read_flat_part(source.file, path, source.size, stereo_view);
    check_memory(path, 2 * memory_of(flat.header, flat.image.channels.size() + 1), source.size);
    const std::string depth = find_depth_channel(flat.image.channels, depth_channel, path);
    return LdiFile{ldi_of_flat(flat.image, depth), flat.header, false, {}};
}

} // namespace

LdiFile read_ldi(const std::string &path, const std::string &depth_channel, const std::string &stereo_view) {
    return with_file_name(path, [&] {
        const auto stream = open_input(path);
        check_header(*stream, path);
        Imf::MultiPartInputFile file(*stream);
        const Source source{file, path, stream->size()};
        const std::vector<int> deep = deep_parts(file);
        if (deep.empty()) return read_flat_as_ldi(source, depth_channel, stereo_view);
        auto [view, numbers] = parts_of_view(file, deep, stereo_view, path);
        const auto beauty = [&](int part) { return is_beauty(file.header(part)); };
        const bool one_beauty = std::ranges::count_if(numbers, beauty) == 1;
        if (one_beauty) std::ranges::stable_partition(numbers, beauty);
        DeepPicture picture(source, view, depth_channel);
        for (const int part : numbers) picture.add(part, one_beauty && part != numbers.front());
        Imf::Header header = header_of_view(file.header(numbers.front()), view);
        if (picture.is_merged()) header.erase("name"); // an object's
        Ldi ldi = picture.whole();
        return LdiFile{std::move(ldi), header, true, picture.notes()};
    });
}

} // namespace sparselens
