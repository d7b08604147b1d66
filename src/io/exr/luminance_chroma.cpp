#include "io/exr/luminance_chroma.h"

#include "base/text.h"

#include <ImfChannelList.h>
#include <ImfRgbaFile.h>

#include <algorithm>
#include <array>
#include <vector>

namespace sparselens {

namespace {
constexpr std::array names{"Y", "RY", "BY"};
}

bool is_luminance_or_chroma(std::string_view channel) { return is_among(names, channel); }

bool is_luminance_chroma(const Imf::Header &header) {
    const Imf::ChannelList &channels = header.channels();
    const auto has = [&](const char *name) { return channels.findChannel(name) != nullptr; };
    return std::ranges::all_of(names, has) && std::ranges::none_of(rgb_names, has);
}

void read_luminance_chroma(InputStream &stream, Image &image) {
    stream.clear();
    stream.seekg(0);
    Imf::RgbaInputFile file(stream);
    const Imath::Box2i data = file.dataWindow();
    const Grid grid(data);
    std::vector<Imf::Rgba> pixels(grid.size());
    file.setFrameBuffer(pixels.data() - data.min.x - std::ptrdiff_t(data.min.y) * grid.width(), 1,
                        std::size_t(grid.width()));
    file.readPixels(data.min.y, data.max.y);
    const auto rgb = find_rgb(image.channels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Imath::V2i at = grid.pixel(i);
        image.at(rgb[0], at.x, at.y) = pixels[i].r;
        image.at(rgb[1], at.x, at.y) = pixels[i].g;
        image.at(rgb[2], at.x, at.y) = pixels[i].b;
    }
}

} // namespace sparselens
