#include "io/exr_flat.h"

#include "io/exr_common.h"
#include "io/exr_header_check.h"
#include "io/memory_limit.h"

#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>

#include <algorithm>

namespace sparselens {

namespace {

bool is_flat(const Imf::Header &header) { return !header.hasType() || !Imf::isDeepData(header.type()); }

int first_flat_part(Imf::MultiPartInputFile &file, const std::string &path) {
    for (int part = 0; part < file.parts(); ++part)
        if (is_flat(file.header(part))) return part;
    throw Error(display_name(path) + ": holds no flat picture");
}

} // namespace

FlatFile read_flat_part(Imf::MultiPartInputFile &file, const std::string &path, std::uint64_t size) {
    const int number = first_flat_part(file, path);
    const Imf::Header &header = file.header(number);
    const std::vector<Channel> channels = channels_of(header, path);
    check_memory(path, memory_of(header, channels.size()), size);
    Imf::InputPart part(file, number);
    Image image(windows_of(header), channels);
    const Windows &w = image.windows;
    Imf::FrameBuffer pixels;
    for (std::size_t k = 0; k < image.channels.size(); ++k) {
        const Channel &channel = image.channels[k];
        const auto type = channel.type == PixelType::uint32 ? Imf::UINT : Imf::FLOAT;
        pixels.insert(channel.name, Imf::Slice::Make(type, image.plane(k).data(), w.data, sizeof(float),
                                                     sizeof(float) * std::size_t(w.width())));
    }
    part.setFrameBuffer(pixels);
    part.readPixels(w.data.min.y, w.data.max.y);
    return FlatFile{std::move(image), header, size};
}

FlatFile read_flat_exr(const std::string &path) {
    return with_file_name(path, [&] {
        const auto stream = open_input(path);
        check_header(*stream, path);
        Imf::MultiPartInputFile file(*stream);
        return read_flat_part(file, path, stream->size());
    });
}

Imf::Header read_flat_header(const std::string &path) {
    return with_file_name(path, [&] {
        const auto stream = open_input(path);
        check_header(*stream, path);
        Imf::MultiPartInputFile file(*stream);
        return file.header(first_flat_part(file, path));
    });
}

std::vector<float> take_depth(Image &image, const std::string &depth_channel, const std::string &path) {
    const std::string name = find_depth_channel(image.channels, depth_channel, path);
    const auto plane = image.plane(find_channel(image.channels, name));
    std::vector<float> depth(plane.begin(), plane.end());
    std::vector<Channel> carried;
    for (const Channel &channel : image.channels)
        if (channel.name != name && !is_placement(channel.name)) carried.push_back(channel);
    Image rest(image.windows, carried);
    for (std::size_t k = 0; k < carried.size(); ++k)
        std::ranges::copy(image.plane(find_channel(image.channels, carried[k].name)), rest.plane(k).begin());
    image = std::move(rest);
    return depth;
}

std::size_t write_flat_exr(const std::string &path, const Image &image, const Imf::Header &metadata) {
    return with_file_name(path, [&] {
        std::size_t clamped = 0;
        const Windows &w = image.windows;
        std::vector<std::vector<char>> stored(image.channels.size());
        Imf::FrameBuffer pixels;
        for (std::size_t k = 0; k < stored.size(); ++k) {
            const Channel &channel = image.channels[k];
            const std::size_t bytes = bytes_of(channel.type);
            stored[k].resize(w.pixels() * bytes);
            clamped += store(channel.type, image.plane(k).data(), w.pixels(), stored[k].data());
            pixels.insert(channel.name, Imf::Slice::Make(imf_type(channel.type), stored[k].data(), w.data,
                                                         bytes, bytes * std::size_t(w.width())));
        }
        Imf::Header header = output_header(w, image.channels, metadata);
        OutputFile output(path);
        header.compression() = output.to_pipe() ? Imf::NO_COMPRESSION : Imf::ZIP_COMPRESSION;
        {
            Imf::OutputFile file(output.stream(), header);
            file.setFrameBuffer(pixels);
            file.writePixels(w.height());
        }
        output.commit();
        return clamped;
    });
}

} // namespace sparselens
