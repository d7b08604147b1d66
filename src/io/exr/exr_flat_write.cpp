#include "base/parallel.h"
#include "io/exr/exr_common.h"
#include "io/exr/exr_flat.h"
#include "io/exr/kept_names.h"

#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>

#include <algorithm>

namespace sparselens {

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
                  image.plane(k).data() + image.windows.index(box.min.x, box.min.y + int(row)), across,
                  values.data());
            char *to = pixels.data() + row * across * in_pixel + offset;
            for (std::size_t x = 0; x < across; ++x, to += in_pixel) std::copy_n(&values[x * size], size, to);
            offset += size;
        }
    });
    return pixels;
}

} // namespace sparselens
