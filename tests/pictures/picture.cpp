#include "pictures/picture.h"

#include "io/exr/exr_common.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineInputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStdIO.h>

#include <cstddef>
#include <stdexcept>

namespace pictures {

namespace {

// Reads uint channels as uint, all others as float.
struct Buffer {
    std::vector<float> floats;
    std::vector<std::uint32_t> ids;

    Buffer(Imf::PixelType type, std::size_t size) {
        if (type == Imf::UINT)
            ids.resize(size);
        else
            floats.resize(size);
    }
    Imf::PixelType type() const { return ids.empty() ? Imf::FLOAT : Imf::UINT; }
    char *at(std::ptrdiff_t i) {
        return ids.empty() ? reinterpret_cast<char *>(floats.data() + i)
                           : reinterpret_cast<char *>(ids.data() + i);
    }
    std::vector<double> doubles() const {
        return ids.empty() ? std::vector<double>(floats.begin(), floats.end())
                           : std::vector<double>(ids.begin(), ids.end());
    }
};

// The address of pixel (0, 0), which may be outside the buffer, for pixels of four bytes.
char *origin(char *first, const Picture &picture) {
    const Imath::V2i min = picture.window().min;
    return first - 4 * (min.x + std::ptrdiff_t(min.y) * picture.width());
}

void read_flat(Imf::MultiPartInputFile &file, Picture &picture) {
    const std::size_t pixels = std::size_t(picture.width()) * std::size_t(picture.height());
    picture.samples.assign(pixels, 1);
    std::vector<Buffer> buffers;
    for (const Channel &channel : picture.channels) buffers.emplace_back(channel.type, pixels);
    Imf::FrameBuffer frame;
    for (std::size_t k = 0; k < buffers.size(); ++k)
        frame.insert(picture.channels[k].name,
                     Imf::Slice(buffers[k].type(), origin(buffers[k].at(0), picture), 4,
                                4 * std::size_t(picture.width())));
    Imf::InputPart part(file, 0);
    part.setFrameBuffer(frame);
    part.readPixels(picture.window().min.y, picture.window().max.y);
    for (std::size_t k = 0; k < buffers.size(); ++k) picture.channels[k].values = buffers[k].doubles();
}

void read_deep(Imf::MultiPartInputFile &file, Picture &picture) {
    const std::size_t pixels = std::size_t(picture.width()) * std::size_t(picture.height());
    const int top = picture.window().min.y, bottom = picture.window().max.y;
    const std::size_t row = std::size_t(picture.width());
    picture.samples.assign(pixels, 0);
    Imf::DeepScanLineInputPart part(file, 0);
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(
        Imf::Slice(Imf::UINT, origin(reinterpret_cast<char *>(picture.samples.data()), picture), 4, 4 * row));
    std::vector<std::vector<char *>> pointers(picture.channels.size(), std::vector<char *>(pixels));
    const Imath::V2i min = picture.window().min;
    for (std::size_t k = 0; k < pointers.size(); ++k) {
        char *base = reinterpret_cast<char *>(pointers[k].data()) -
                     std::ptrdiff_t(sizeof(char *)) * (min.x + std::ptrdiff_t(min.y) * picture.width());
        const Imf::PixelType type = picture.channels[k].type == Imf::UINT ? Imf::UINT : Imf::FLOAT;
        frame.insert(picture.channels[k].name,
                     Imf::DeepSlice(type, base, sizeof(char *), sizeof(char *) * row, 4));
    }
    part.setFrameBuffer(frame);
    part.readPixelSampleCounts(top, bottom);
    std::size_t samples = 0;
    for (const std::uint32_t count : picture.samples) samples += count;
    std::vector<Buffer> buffers;
    for (std::size_t k = 0; k < pointers.size(); ++k) {
        buffers.emplace_back(picture.channels[k].type, samples);
        std::ptrdiff_t at = 0;
        for (std::size_t i = 0; i < pixels; at += picture.samples[i++]) pointers[k][i] = buffers[k].at(at);
    }
    part.readPixels(top, bottom);
    for (std::size_t k = 0; k < buffers.size(); ++k) picture.channels[k].values = buffers[k].doubles();
}

} // namespace

const Channel &Picture::channel(const std::string &name) const {
    for (const Channel &c : channels)
        if (c.name == name) return c;
    throw std::runtime_error("there is no channel " + name);
}

Picture read(const std::string &name) try {
    Imf::StdIFStream stream(name.c_str());
    Imf::MultiPartInputFile file = sparselens::open_exr(stream);
    if (file.parts() != 1) throw std::runtime_error("has more than one part");
    Picture picture{file.header(0)};
    picture.deep = picture.header.hasType() && picture.header.type() == Imf::DEEPSCANLINE;
    const Imf::ChannelList &list = picture.header.channels();
    for (auto c = list.begin(); c != list.end(); ++c)
        picture.channels.push_back({c.name(), c.channel().type, {}});
    if (picture.deep)
        read_deep(file, picture);
    else
        read_flat(file, picture);
    return picture;
} catch (const std::exception &error) {
    throw std::runtime_error(name + ": " + error.what());
}

void write(const Picture &picture, const std::string &name) {
    if (picture.deep) throw std::runtime_error(name + ": deep pictures are only read");
    Imf::Header header = picture.header;
    header.channels() = Imf::ChannelList();
    std::vector<std::vector<float>> floats;
    std::vector<std::vector<half>> halves;
    Imf::FrameBuffer frame;
    const Imath::V2i min = picture.window().min;
    const std::size_t row = std::size_t(picture.width());
    for (const Channel &channel : picture.channels) {
        if (channel.type == Imf::UINT) throw std::runtime_error(name + ": channels of ids are only read");
        header.channels().insert(channel.name, Imf::Channel(channel.type));
        char *first = nullptr;
        std::size_t size = 4;
        if (channel.type == Imf::HALF) {
            halves.emplace_back();
            for (const double v : channel.values) halves.back().push_back(half(float(v)));
            first = reinterpret_cast<char *>(halves.back().data());
            size = 2;
        } else {
            floats.emplace_back(channel.values.begin(), channel.values.end());
            first = reinterpret_cast<char *>(floats.back().data());
        }
        const std::ptrdiff_t before = min.x + std::ptrdiff_t(min.y) * picture.width();
        frame.insert(channel.name,
                     Imf::Slice(channel.type, first - std::ptrdiff_t(size) * before, size, size * row));
    }
    Imf::OutputFile file(name.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(picture.height());
}

} // namespace pictures
