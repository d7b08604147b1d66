#include "io/exr/exr_flat.h"

#include "base/parallel.h"
#include "base/text.h"
#include "deep/channel_alpha.h"
#include "deep/sanitize.h"
#include "io/exr/exr_channels.h"
#include "io/exr/exr_common.h"
#include "io/exr/exr_header.h"
#include "io/files/memory_limit.h"

#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStdIO.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

namespace sparselens {

namespace {

bool is_flat(const Imf::Header &header) { return !header.hasType() || !Imf::isDeepData(header.type()); }

std::vector<int> flat_parts(const Imf::MultiPartInputFile &file, const std::string &path) {
    std::vector<int> numbers;
    for (int part = 0; part < file.parts(); ++part)
        if (is_flat(file.header(part))) numbers.push_back(part);
    if (numbers.empty())
        throw Error(
            display_name(path) +
            ": contains deep samples but no flat picture; flatten it first (dof-gather --lens-radius 0)");
    return numbers;
}

// The channels to read from a part, by the names they get in the picture.
struct PartChannels {
    int part;
    std::vector<FileChannel> channels;
};

struct PictureParts {
    std::string view;
    Windows windows;                 // over all parts
    std::vector<PartChannels> parts; // not empty, the beauty first
    std::vector<std::string> notes = {}, warnings = {};

    std::vector<Channel> channels() const {
        std::vector<Channel> all;
        for (const PartChannels &part : parts)
            for (const FileChannel &found : part.channels) all.push_back(found.channel);
        return all;
    }
    std::vector<FileChannel> file_channels() const {
        std::vector<FileChannel> all;
        for (const PartChannels &part : parts)
            all.insert(all.end(), part.channels.begin(), part.channels.end());
        return all;
    }
};

// Finds R, G, B and A of the picture, and adds notes about them.
void find_beauty(const Imf::MultiPartInputFile &file, PictureParts &picture) {
    const std::vector<Channel> channels = picture.channels();
    for (std::string &warning : beauty_warnings(channels)) picture.warnings.push_back(std::move(warning));
    if (const std::vector<PictureLayer> layers = pictures_in(channels); !layers.empty())
        for (PartChannels &part : picture.parts) name_beauty(part.channels, layers.front().beauty, channels);
    for (const PartChannels &part : picture.parts)
        if (std::ranges::any_of(part.channels, [](const FileChannel &c) { return c.channel.name == "R"; }))
            picture.notes.push_back(beauty_note(
                part.channels, file.parts() > 1 ? layer_of(file.header(part.part)) : std::string()));
}

// Warns of a part of depth that does not cover the part of the colours.
void compare_depth(const Imf::MultiPartInputFile &file, const std::string &asked, const std::string &path,
                   PictureParts &picture) {
    std::vector<Channel> channels = picture.channels();
    std::erase_if(channels, [](const Channel &c) { return c.type == PixelType::uint32; });
    if (!has_depth_channel(channels, asked)) return;
    const std::string depth = find_depth_channel(channels, asked, path).name;
    Imath::Box2i of_depth, of_colours;
    for (const PartChannels &part : picture.parts)
        for (const FileChannel &found : part.channels) {
            if (found.channel.name == depth) of_depth = file.header(part.part).dataWindow();
            if (found.channel.name == "R") of_colours = file.header(part.part).dataWindow();
        }
    Imath::Box2i both = of_depth;
    both.extendBy(of_colours);
    if (both == of_depth) return;
    const auto text = [](const Imath::Box2i &box) {
        return fmt::format("{}x{} pixels at {},{}", box.size().x + 1, box.size().y + 1, box.min.x, box.min.y);
    };
    picture.warnings.push_back(fmt::format(
        "depth {} covers {}, but the colours cover {}: colours without a depth count as infinitely far",
        depth, text(of_depth), text(of_colours)));
}

using Chosen = std::optional<ChannelsOfPicture>; // one of the file's pictures; empty: all channels

// A channel takes the name of its part as a layer (R of "diffuse" becomes diffuse.R) if its own name is taken, if only
// the part's name shows that it is a depth, or if `depth` asks for it by that name.
void add_part(Imf::MultiPartInputFile &file, int number, const std::string &path, const Chosen &chosen,
              const std::string &depth, std::unordered_set<std::string> &taken, PictureParts &picture) {
    PartChannels part{number, {}};
    const std::string layer = layer_of(file.header(number));
    for (FileChannel &found : channels_of(file.header(number), picture.view, path)) {
        const std::string &name = found.channel.name;
        if (chosen) rename(found, chosen->name_of(full_name(name, layer, file.parts() > 1)));
        if (name.empty()) continue;
        const std::string full = full_name(name, layer, file.parts() > 1);
        if (full == depth || (depth_rank(full) && !depth_rank(name))) rename(found, full);
        if (taken.contains(name)) rename(found, layer + "." + name);
        if (!taken.insert(name).second) { // the file has the same layer twice
            picture.warnings.push_back(fmt::format(
                "channel {} of part {} is not used: there is one of that name", found.in_file, layer));
            continue;
        }
        part.channels.push_back(std::move(found));
    }
    colours_first(part.channels);
    if (!part.channels.empty() || !chosen) picture.parts.push_back(std::move(part));
}

// Pictures with other display windows come from another camera.
bool fits(const Windows &part, const Windows &picture) {
    return part.display == picture.display && part.pixel_aspect == picture.pixel_aspect;
}

// Whether the part holds the beauty of the chosen picture.
bool holds_beauty(const Imf::MultiPartInputFile &file, int part, const std::string &view,
                  const std::string &path, const Chosen &chosen) {
    if (!chosen) return is_beauty(file.header(part));
    return std::ranges::any_of(full_channels(file, {part}, view, path),
                               [&](const Channel &c) { return chosen->name_of(c.name) == "R"; });
}

// The flat parts that make up the picture, with the window that contains all of them. The beauty comes first.
PictureParts parts_of_picture(Imf::MultiPartInputFile &file, const std::string &path,
                              const PictureChoice &choice) {
    auto [view, numbers] = parts_of_view(file, flat_parts(file, path), choice.stereo_view, path);
    const std::vector<Channel> all = full_channels(file, numbers, view, path);
    Chosen chosen;
    const std::string depth = choice.depth_file.empty() ? choice.depth : std::string();
    if (const auto layer = chosen_picture(all, choice.layer, path)) chosen.emplace(*layer, all, depth);
    const auto beauty = std::ranges::find_if(
        numbers, [&, &view = view](int part) { return holds_beauty(file, part, view, path, chosen); });
    if (beauty != numbers.end()) std::rotate(numbers.begin(), beauty, beauty + 1);
    PictureParts picture{view, windows_of(file.header(numbers.front())), {}};
    std::unordered_set<std::string> taken; // names
    for (const int part : numbers) {
        const Windows windows = windows_of(file.header(part));
        if (!fits(windows, picture.windows)) {
            picture.warnings.push_back(
                fmt::format("part {} is not used: its display window is not that of part {}",
                            layer_of(file.header(part)), layer_of(file.header(numbers.front()))));
            continue;
        }
        picture.windows.data.extendBy(windows.data);
        add_part(file, part, path, chosen, depth, taken, picture);
    }
    find_beauty(file, picture);
    if (choice.depth_file.empty()) compare_depth(file, choice.depth, path, picture);
    return picture;
}

Imf::Header header_of(const Imf::MultiPartInputFile &file, const PictureParts &picture,
                      const std::string &path) {
    Imf::Header header = header_of_view(file.header(picture.parts.front().part), picture.view);
    if (is_standard_stream(path))
        header.compression() = Imf::ZIP_COMPRESSION; // a pipe's compression says nothing about the picture
    header.dataWindow() = picture.windows.data;
    keep_names(header, picture.file_channels());
    return with_mattes_of(file, header);
}

// Coverage for colours that do not fill the window of the picture and have no alpha: 1 in their own window.
struct MissingCoverage {
    Imath::Box2i covered; // empty: none is missing
    MissingCoverage(const Imf::MultiPartInputFile &file, const PictureParts &picture) {
        const std::vector<Channel> channels = picture.channels();
        if (find_channel(channels, "A") != npos || find_channel(channels, "AR") != npos) return;
        for (const PartChannels &part : picture.parts)
            for (const FileChannel &found : part.channels)
                if (found.channel.name == "R") covered = file.header(part.part).dataWindow();
        if (covered == picture.windows.data) covered.makeEmpty();
    }
    void fill(Image &image) const {
        const std::size_t a = find_channel(image.channels, "A");
        for (int y = covered.min.y; y <= covered.max.y; ++y)
            for (int x = covered.min.x; x <= covered.max.x; ++x) image.at(a, x, y) = 1;
    }
};

// Reads the part's channels into the picture's channels from k on. Returns the index after the last one. Outside of the
// part's window the picture stays 0; a depth of 0 means nothing.
std::size_t read_channels(Imf::MultiPartInputFile &file, const PartChannels &part, Image &image,
                          std::size_t k) {
    const Windows &w = image.windows;
    Imf::FrameBuffer pixels;
    for (const auto &[in_file, channel, kept] : part.channels) {
        const auto type = channel.type == PixelType::uint32 ? Imf::UINT : Imf::FLOAT;
        pixels.insert(in_file, Imf::Slice::Make(type, image.plane(k++).data(), w.data, sizeof(float),
                                                sizeof(float) * std::size_t(w.width())));
    }
    if (pixels.begin() == pixels.end()) return k;
    Imf::InputPart input(file, part.part);
    input.setFrameBuffer(pixels);
    const Imath::Box2i &own = file.header(part.part).dataWindow();
    input.readPixels(own.min.y, own.max.y);
    return k;
}

// For the first channel of which that is true.
std::string why_ids_are_lost(const Imf::MultiPartInputFile &file, const PictureParts &picture) {
    for (const PartChannels &part : picture.parts)
        for (const FileChannel &found : part.channels)
            if (std::string why = why_ids_are_lost(file.header(part.part).compression(), found.channel);
                !why.empty())
                return why;
    return {};
}

} // namespace

FlatFile read_flat_part(Imf::MultiPartInputFile &file, const std::string &path, std::uint64_t size,
                        const PictureChoice &choice) {
    PictureParts picture = parts_of_picture(file, path, choice);
    std::vector<Channel> channels = picture.channels();
    const Imf::Header header = with_stated_kinds(header_of(file, picture, path), choice, channels, path);
    find_kinds_by(header, channels);
    if (std::string why = why_ids_are_lost(file, picture); !why.empty())
        picture.warnings.push_back(std::move(why));
    const MissingCoverage missing(file, picture);
    if (!missing.covered.isEmpty()) channels.push_back({"A"});
    check_memory(path, memory_of(header, channels.size()), size);
    Image image(picture.windows, channels);
    std::size_t k = 0;
    for (const PartChannels &part : picture.parts) k = read_channels(file, part, image, k);
    if (!missing.covered.isEmpty()) missing.fill(image);
    add_mean_coverage(image);
    FlatFile result{std::move(image), header, size, std::move(picture.notes), std::move(picture.warnings)};
    if (!choice.depth_file.empty()) put_depth_of_file(result, path, choice, read_depth_file(choice));
    if (choice.unpremultiplied) premultiply(result.image);
    return result;
}

FlatFile read_flat_exr(const std::string &path, const PictureChoice &choice) {
    return with_exr(path, [&](Imf::MultiPartInputFile &file, const InputStream &stream) {
        return read_flat_part(file, path, stream.bytes(), choice);
    });
}

Imf::Header read_flat_header(const std::string &path, const PictureChoice &choice) {
    return with_exr(path, [&](Imf::MultiPartInputFile &file, const InputStream &) {
        return header_of(file, parts_of_picture(file, path, choice), path);
    });
}

bool is_deep_alone(const std::string &path) {
    if (is_read_once(path)) return false;
    return with_exr(path, [&](const Imf::MultiPartInputFile &file, const InputStream &) {
        for (int part = 0; part < file.parts(); ++part)
            if (is_flat(file.header(part))) return false;
        return true;
    });
}

std::vector<float> take_depth(Image &image, const std::string &depth_channel, const std::string &path) {
    const std::string name = find_depth_channel(image.channels, depth_channel, path).name;
    const auto plane = image.plane(find_channel(image.channels, name));
    std::vector<float> depth(plane.begin(), plane.end());
    std::size_t carried = 0; // moves channels in place, because a picture may have many
    for (std::size_t k = 0; k < image.channels.size(); ++k) {
        if (image.channels[k].name == name || is_position_channel(image.channels[k].name)) continue;
        if (carried != k) {
            image.channels[carried] = std::move(image.channels[k]);
            std::ranges::copy(image.plane(k), image.plane(carried).begin());
        }
        ++carried;
    }
    image.channels.resize(carried);
    image.values.resize(carried * image.windows.pixels());
    return depth;
}

namespace {

// The values of the channels, stored for a file, each by rows. Returns the number of clamped values.
std::size_t store_all(const Image &image, std::vector<std::vector<char>> &stored) {
    std::size_t clamped = 0;
    for (std::size_t k = 0; k < image.channels.size(); ++k) {
        const PixelType type = image.channels[k].type;
        stored.emplace_back(image.windows.pixels() * bytes_of(type));
        clamped += store(type, image.plane(k).data(), image.windows.pixels(), stored.back().data());
    }
    return clamped;
}

std::size_t write_to(Imf::OStream &stream, bool to_pipe, const Image &image, const Imf::Header &metadata,
                     std::optional<Imf::Compression> compression, int tiles) {
    const Windows &w = image.windows;
    const std::vector<Channel> channels = by_kept_names(image.channels, metadata);
    std::vector<std::vector<char>> stored;
    const std::size_t clamped = store_all(image, stored);
    Imf::FrameBuffer pixels;
    for (std::size_t k = 0; k < stored.size(); ++k) {
        const std::size_t bytes = bytes_of(channels[k].type);
        pixels.insert(channels[k].name, Imf::Slice::Make(imf_type(channels[k].type), stored[k].data(), w.data,
                                                         bytes, bytes * std::size_t(w.width())));
    }
    Imf::Header header = output_header(w, channels, metadata);
    header.compression() = output_compression(false, compression, to_pipe, metadata, image.channels);
    if (tiles > 0) {
        header.setTileDescription(Imf::TileDescription(unsigned(tiles), unsigned(tiles)));
        Imf::TiledOutputFile file(stream, header);
        file.setFrameBuffer(pixels);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(pixels);
        file.writePixels(w.height());
    }
    return clamped;
}

} // namespace

std::size_t write_flat_exr(const std::string &path, const Image &image, const Imf::Header &metadata,
                           std::optional<Imf::Compression> compression, int tiles) {
    return with_file_name(path, [&] {
        OutputFile output(path);
        const std::size_t clamped =
            write_to(output.stream(), output.to_pipe(), image, metadata, compression, tiles);
        output.commit();
        return clamped;
    });
}

std::string flat_exr(const std::string &name, const Image &image, const Imf::Header &metadata,
                     std::optional<Imf::Compression> compression, int tiles) {
    return with_file_name(name, [&] {
        Imf::StdOSStream stream;
        write_to(stream, false, image, metadata, compression, tiles);
        return stream.str();
    });
}

std::vector<Channel> channels_in_file(const Image &image, const Imf::Header &metadata) {
    return by_kept_names(image.channels, metadata);
}

std::string stored_pixels(const Image &image, const Imath::Box2i &box,
                          std::span<const std::size_t> channels) {
    const std::size_t across = std::size_t(box.max.x - box.min.x + 1),
                      down = std::size_t(box.max.y - box.min.y + 1);
    std::size_t in_pixel = 0;
    for (const std::size_t k : channels) in_pixel += bytes_of(image.channels[k].type);
    std::string pixels(across * down * in_pixel, '\0');
    parallel_for(down, [&](std::size_t row) {
        std::vector<char> values;
        std::size_t offset = 0;
        for (const std::size_t k : channels) {
            const std::size_t size = bytes_of(image.channels[k].type);
            values.resize(across * size);
            store(image.channels[k].type,
                  image.plane(k).data() + image.windows.index(Imath::V2i(box.min.x, box.min.y + int(row))),
                  across, values.data());
            char *to = pixels.data() + row * across * in_pixel + offset;
            for (std::size_t x = 0; x < across; ++x, to += in_pixel) std::copy_n(&values[x * size], size, to);
            offset += size;
        }
    });
    return pixels;
}

} // namespace sparselens
