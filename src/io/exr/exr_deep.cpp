#include "io/exr/exr_deep.h"

#include "base/parallel.h"
#include "base/text.h"
#include "deep/channel_alpha.h"
#include "deep/merge.h"
#include "deep/sanitize.h"
#include "io/exr/exr_channels.h"
#include "io/exr/exr_common.h"
#include "io/exr/exr_deep_part.h"
#include "io/exr/exr_flat.h"
#include "io/exr/exr_header.h"
#include "io/files/memory_limit.h"

#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace sparselens {

namespace {

std::vector<int> deep_parts(const Imf::MultiPartInputFile &file) {
    std::vector<int> numbers;
    for (int part = 0; part < file.parts(); ++part)
        if (file.header(part).hasType() && Imf::isDeepData(file.header(part).type())) numbers.push_back(part);
    return numbers;
}

double memory_held_by(const Ldi &ldi) {
    return double(ldi.begin.size()) * sizeof(ldi.begin[0]) +
           double(ldi.begin.back()) * double((ldi.values.size() + 5) * sizeof(float));
}

// The parts of one view as one picture, see read_ldi().
class DeepPicture {
public:
    DeepPicture(const DeepSource &source, const std::string &view, const PictureChoice &choice)
        : source_(source), view_(view), asked_(choice.depth), layer_(choice.layer),
          unpremultiplied_(choice.unpremultiplied) {}

    // The parts that hold channels of the requested layer.
    std::vector<int> parts_of_layer(const std::vector<int> &numbers) {
        if (layer_.empty()) return numbers;
        const std::vector<Channel> all = full_channels(source_.file, numbers, view_, source_.path);
        chosen_.emplace(*chosen_picture(all, layer_, source_.path), all, asked_);
        std::vector<int> kept;
        for (const int number : numbers)
            if (std::ranges::any_of(full_channels(source_.file, {number}, view_, source_.path),
                                    [&](const Channel &channel) { return chosen_->owns(channel.name); }))
                kept.push_back(number);
        return kept;
    }

    // Finds out whether layers of these parts must provide the beauty, because none has a colour outside of all layers.
    void find_beauty(const std::vector<int> &numbers) {
        for (const int number : numbers)
            for (const FileChannel &found : channels_of(source_.file.header(number), view_, source_.path))
                if (is_among(rgb_names, found.channel.name)) beauty_in_layer_ = false;
    }

    // `reduce`: only if there is a single part.
    void add(int number, bool only_as_layer, const ReduceRows &reduce = {}) {
        const Imf::Header &header = source_.file.header(number);
        const std::vector<FileChannel> channels = named_channels(header);
        const DepthChannel found = depth_of(channels);
        const std::string &depth = found.name;
        by_rows_ = reduce && !depth.empty() && header.type() == Imf::DEEPSCANLINE;
        Ldi part =
            read_deep_part(source_, number, channels, depth, by_rows_ ? reduce : ReduceRows(), packed_);
        const auto whose = std::ranges::find_if(parts_, [&](const Ldi &other) {
            return depth.empty() ? part.windows == other.windows && part.begin == other.begin
                                 : same_samples(part, other);
        });
        const std::string name = layer_of(header);
        if (whose == parts_.end() && only_as_layer) {
            warnings_.push_back(
                fmt::format("part {} is left out: its samples are not those of the beauty", name));
            return;
        }
        if (parts_.empty()) {
            notes_.push_back(beauty_note(channels, source_.file.parts() > 1 ? name : std::string()));
            notes_.push_back("depth: " + depth);
            if (found.warning) warnings_.push_back(*found.warning);
        }
        source_.held += memory_held_by(part);
        keep(channels, whose == parts_.end() ? nullptr : &*whose, name);
        if (whose != parts_.end()) return add_layer(*whose, std::move(part), name);
        if (depth.empty())
            throw Error(
                fmt::format("{}: part {} has neither a depth channel nor the samples of an earlier part",
                            display_name(source_.path), name));
        add_mean_coverage(part);
        check_types(part);
        parts_.push_back(std::move(part));
    }

    bool is_merged() const { return parts_.size() > 1; }

    Ldi whole() {
        if (unpremultiplied_ && !by_rows_)
            for (Ldi &part : parts_) premultiply(part);
        if (!is_merged()) return std::move(parts_[0]);
        notes_.push_back(fmt::format("{} deep parts are merged", parts_.size()));
        Imath::Box2i data;
        for (const Ldi &part : parts_) data.extendBy(part.windows.data);
        Imf::Header all;
        all.dataWindow() = data;
        check_memory(source_.path, 2 * source_.held + memory_of(all, 2), source_.size);
        return deep_merge(parts_);
    }

    std::optional<PackedRows> packed() { return std::move(packed_); }
    const KeptNames &kept_names() const { return kept_; }
    std::vector<std::string> notes() const { return notes_; }
    std::vector<std::string> warnings() const { return warnings_; }

private:
    std::vector<FileChannel> named_channels(const Imf::Header &header) {
        std::vector<FileChannel> found = channels_of(header, view_, source_.path);
        if (chosen_) return of_layer(std::move(found), layer_of(header));
        if (!beauty_in_layer_) return found;
        const std::vector<Channel> channels = plain(found);
        chosen_picture(channels, {}, source_.path); // throws if there are several
        if (const std::vector<PictureLayer> layers = pictures_in(channels); !layers.empty())
            name_beauty(found, layers.front().beauty, channels);
        if (parts_.empty()) warnings_ = beauty_warnings(channels);
        return found;
    }

    std::vector<FileChannel> of_layer(std::vector<FileChannel> channels, const std::string &part) const {
        for (FileChannel &found : channels)
            rename(found, chosen_->name_of(full_name(found.channel.name, part, source_.file.parts() > 1)));
        std::erase_if(channels, [](const FileChannel &found) { return found.channel.name.empty(); });
        colours_first(channels);
        return channels;
    }

    // Records the names that a part's channels keep in files. If `whose` is given, the part becomes a layer of it.
    void keep(const std::vector<FileChannel> &channels, const Ldi *whose, const std::string &part) {
        for (FileChannel found : channels) {
            if (whose && find_channel(whose->channels, found.channel.name) != npos)
                rename(found, part + "." + found.channel.name);
            if (!found.kept.empty()) kept_.emplace(found.channel.name, found.kept);
        }
    }

    static std::vector<Channel> plain(const std::vector<FileChannel> &found) {
        std::vector<Channel> channels;
        for (const FileChannel &channel : found) channels.push_back(channel.channel);
        return channels;
    }

    void check_types(const Ldi &part) const {
        for (const Ldi &other : parts_)
            for (const Channel &channel : part.channels) {
                const std::size_t k = find_channel(other.channels, channel.name);
                const auto holds_ids = [](const Channel &c) { return c.type == PixelType::uint32; };
                if (k != npos && holds_ids(other.channels[k]) != holds_ids(channel))
                    throw Error(
                        fmt::format("{}: channel {} holds integers in one deep part but not in another",
                                    display_name(source_.path), channel.name));
            }
    }

    // The first part must have a depth; later parts may be layers of it.
    DepthChannel depth_of(const std::vector<FileChannel> &found) const {
        const std::vector<Channel> channels = plain(found);
        const bool may_lack = !parts_.empty() && !has_depth_channel(channels, asked_);
        return may_lack ? DepthChannel{} : find_depth_channel(channels, asked_, source_.path);
    }

    DeepSource source_;
    std::string view_, asked_, layer_;
    std::optional<ChannelsOfPicture> chosen_;
    std::vector<Ldi> parts_;
    std::optional<PackedRows> packed_; // the samples of the only part
    std::vector<std::string> notes_, warnings_;
    bool beauty_in_layer_ = true, unpremultiplied_ = false;
    bool by_rows_ = false; // the rows of the only part came one after the other, ready for use
    KeptNames kept_;
};

LdiFile read_flat_as_ldi(const DeepSource &source, const PictureChoice &choice) {
    const std::string &path = source.path;
    FlatFile flat = read_flat_part(source.file, path, source.size, choice);
    check_memory(path, 2 * memory_of(flat.header, flat.image.channels.size() + 1), source.size);
    const DepthChannel depth = find_depth_channel(flat.image.channels, choice.depth_in_memory(), path);
    if (choice.depth_file.empty()) flat.notes.push_back("depth: " + depth.name);
    if (depth.warning) flat.warnings.push_back(*depth.warning);
    return LdiFile{ldi_of_flat(flat.image, depth.name), flat.header, false, std::move(flat.notes),
                   std::move(flat.warnings)};
}

} // namespace

LdiFile read_ldi(const std::string &path, const PictureChoice &choice) { return read_ldi(path, choice, {}); }

LdiFile read_ldi(const std::string &path, const PictureChoice &choice, const ReduceFileRows &reduce) {
    return with_exr(path, [&](Imf::MultiPartInputFile &file, const InputStream &stream) {
        const DeepSource source{file, stream, path, stream.bytes()};
        const std::vector<int> deep = deep_parts(file);
        if (deep.empty()) return read_flat_as_ldi(source, choice);
        if (!choice.depth_file.empty())
            throw UsageError(
                fmt::format("`depth_file`: goes with flat pictures, and {} is deep: its samples have "
                            "depths of their own",
                            display_name(path)));
        const PartsOfView of_view = parts_of_view(file, deep, choice.stereo_view, path);
        const std::string &view = of_view.view;
        DeepPicture picture(source, view, choice);
        std::vector<int> numbers = picture.parts_of_layer(of_view.numbers);
        const auto beauty = [&](int part) { return is_beauty(file.header(part)); };
        const bool one_beauty = std::ranges::count_if(numbers, beauty) == 1;
        if (one_beauty) std::stable_partition(numbers.begin(), numbers.end(), beauty);
        picture.find_beauty(numbers);
        Imf::Header header =
            with_stated_kinds(with_mattes_of(file, header_of_view(file.header(numbers.front()), view)),
                              choice, full_channels(file, numbers, view, path), path);
        const auto by_rows = [&](Ldi rows) {
            add_mean_coverage(rows);
            find_kinds_by(header, rows.channels);
            if (choice.unpremultiplied) premultiply(rows);
            return reduce(header, std::move(rows));
        };
        for (const int part : numbers)
            picture.add(part, one_beauty && part != numbers.front(),
                        reduce && numbers.size() == 1 ? ReduceRows(by_rows) : ReduceRows());
        if (picture.is_merged()) header = without_attribute(header, "name"); // it names an object
        if (is_standard_stream(path))
            header.compression() = Imf::ZIPS_COMPRESSION; // a pipe's compression is not the picture's
        Ldi ldi = picture.whole();
        find_kinds_by(header, ldi.channels);
        std::vector<std::string> warnings = picture.warnings();
        const auto covers = [](const Channel &channel) {
            return colour_part(channel) == ColourPart::coverage;
        };
        if (std::ranges::none_of(ldi.channels, covers) && std::ranges::any_of(ldi.channels, is_light))
            warnings.emplace_back(
                "has no coverage (A, or AR, AG and AB), so that every sample hides what is behind it");
        set_kept_names(header, picture.kept_names());
        std::vector<std::string> notes = picture.notes();
        if (const auto flat = std::size_t(file.parts()) - deep.size(); flat > 0)
            notes.push_back(fmt::format("{} flat parts are not used beside the deep ones", flat));
        return LdiFile{std::move(ldi), header, true, std::move(notes), std::move(warnings), picture.packed()};
    });
}

namespace {

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
    add("ldi.optical", PixelType::float32, ldi.image_z);
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
    const std::size_t first = w.index(Imath::V2i(w.data.min.x, first_row));
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
