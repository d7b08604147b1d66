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
#include <array>
#include <cctype>

namespace sparselens {

namespace {

bool is_flat(const Imf::Header &header) { return !header.hasType() || !Imf::isDeepData(header.type()); }

int first_flat_part(Imf::MultiPartInputFile &file, const std::string &path) {
    for (int part = 0; part < file.parts(); ++part)
        if (is_flat(file.header(part))) return part;
    throw Error(display_name(path) + ": holds no flat picture");
}

std::string view_of(const Imf::Header &header) { return header.hasView() ? header.view() : std::string(); }

// The part's name without its view, which the file format makes part of it: "diffuse" of "diffuse.left".
std::string layer_of(const Imf::Header &header) {
    std::string name = header.hasName() ? header.name() : std::string();
    const std::string view = "." + view_of(header);
    if (view.size() > 1 && name.ends_with(view)) name.resize(name.size() - view.size());
    return name;
}

// Whether the part bears a name that renderers give to the beauty.
bool is_beauty(const Imf::Header &header) {
    static constexpr std::array names{"", "rgba", "rgb", "beauty", "c", "main", "default"};
    std::string name = layer_of(header);
    for (char &c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
    return std::ranges::find(names, name) != names.end();
}

// What is read of a part: its names of channels, and those they get in the picture.
struct PartChannels {
    int part;
    std::vector<std::pair<std::string, Channel>> channels;
};

// A channel whose name is taken is one of the part's layer: R of "diffuse" is diffuse.R.
void add_part(Imf::MultiPartInputFile &file, int number, const std::string &path,
              std::vector<std::string> &taken, std::vector<PartChannels> &parts) {
    PartChannels part{number, {}};
    for (const Channel &channel : channels_of(file.header(number), path)) {
        const auto is_taken = [&](const std::string &name) {
            return std::ranges::find(taken, name) != taken.end();
        };
        Channel named = channel;
        if (is_taken(named.name)) named.name = layer_of(file.header(number)) + "." + channel.name;
        if (is_taken(named.name)) continue; // the same layer twice: the first is it
        taken.push_back(named.name);
        part.channels.emplace_back(channel.name, named);
    }
    parts.push_back(std::move(part));
}

// The flat parts that make up the first view: those of one data window. The beauty first.
std::vector<PartChannels> parts_of_picture(Imf::MultiPartInputFile &file, const std::string &path) {
    const int first = first_flat_part(file, path);
    const std::string view = view_of(file.header(first));
    std::vector<int> numbers;
    for (int part = first; part < file.parts(); ++part)
        if (is_flat(file.header(part)) && view_of(file.header(part)) == view) numbers.push_back(part);
    const auto beauty = std::ranges::find_if(numbers, [&](int part) { return is_beauty(file.header(part)); });
    if (beauty != numbers.end()) std::rotate(numbers.begin(), beauty, beauty + 1);
    std::vector<PartChannels> parts;
    std::vector<std::string> taken;
    const Windows windows = windows_of(file.header(numbers.front()));
    for (const int part : numbers)
        if (windows_of(file.header(part)) == windows) add_part(file, part, path, taken, parts);
    return parts;
}

// Reads the part's channels into the picture's from k on; returns which comes next.
std::size_t read_channels(Imf::MultiPartInputFile &file, const PartChannels &part, Image &image,
                          std::size_t k) {
    const Windows &w = image.windows;
    Imf::FrameBuffer pixels;
    for (const auto &[name, channel] : part.channels) {
        const auto type = channel.type == PixelType::uint32 ? Imf::UINT : Imf::FLOAT;
        pixels.insert(name, Imf::Slice::Make(type, image.plane(k++).data(), w.data, sizeof(float),
                                             sizeof(float) * std::size_t(w.width())));
    }
    if (part.channels.empty()) return k;
    Imf::InputPart input(file, part.part);
    input.setFrameBuffer(pixels);
    input.readPixels(w.data.min.y, w.data.max.y);
    return k;
}

} // namespace

FlatFile read_flat_part(Imf::MultiPartInputFile &file, const std::string &path, std::uint64_t size) {
    const std::vector<PartChannels> parts = parts_of_picture(file, path);
    const Imf::Header &header = file.header(parts.front().part);
    std::vector<Channel> channels;
    for (const PartChannels &part : parts)
        for (const auto &[in_part, channel] : part.channels) channels.push_back(channel);
    check_memory(path, memory_of(header, channels.size()), size);
    Image image(windows_of(header), channels);
    std::size_t k = 0;
    for (const PartChannels &part : parts) k = read_channels(file, part, image, k);
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
        return file.header(parts_of_picture(file, path).front().part);
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
