#include "io/exr/luminance_chroma.h"

#include "base/image.h"
#include "base/text.h"

#include <ImfChannelList.h>
#include <ImfRgbaYca.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <utility>

namespace sparselens {

namespace {

constexpr std::array names{"Y", "RY", "BY"};
constexpr int reach = Imf::RgbaYca::N2; // of the filters, to each side

Imath::V3f luminance_weights(const Imf::Header &header) {
    return Imf::RgbaYca::computeYw(Imf::hasChromaticities(header) ? Imf::chromaticities(header)
                                                                  : Imf::Chromaticities());
}

// The column or row whose chroma the filters use for `at`: beyond the edge, the last one with chroma.
int within(int at, int size) { return std::clamp(at, 0, at < size ? size - 1 : (size - 1) / 2 * 2); }

} // namespace

bool is_luminance_or_chroma(std::string_view channel) { return is_among(names, channel); }

bool is_luminance_chroma(const Imf::Header &header) {
    const Imf::ChannelList &channels = header.channels();
    const auto has = [&](const char *name) { return channels.findChannel(name) != nullptr; };
    return std::ranges::all_of(names, has) && std::ranges::none_of(rgb_names, has);
}

LuminanceChroma::LuminanceChroma(const Imf::Header &header)
    : grid_(header.dataWindow()), weights_(luminance_weights(header)),
      pixels_(grid_.size(), Imf::Rgba(0, 0, 0, 1)) {}

void LuminanceChroma::insert_into(Imf::FrameBuffer &buffer) {
    const auto slice = [&](half &first, int sampling) {
        const std::size_t step = sizeof(Imf::Rgba) * std::size_t(sampling);
        return Imf::Slice::Make(Imf::HALF, &first, grid_.box(), step, step * std::size_t(grid_.width()),
                                sampling, sampling);
    };
    buffer.insert("Y", slice(pixels_.front().g, 1));
    buffer.insert("RY", slice(pixels_.front().r, 2));
    buffer.insert("BY", slice(pixels_.front().b, 2));
}

void LuminanceChroma::write(const std::array<std::span<float>, 3> &planes, const Grid &to) {
    const int width = grid_.width(), height = grid_.height();
    std::vector<Imf::Rgba> padded(std::size_t(width) + 2 * std::size_t(reach));
    for (int y = 0; y < height; y += 2) {
        Imf::Rgba *const own = &pixels_[std::size_t(y) * std::size_t(width)];
        for (int x = -reach; x < width + reach; ++x) padded[std::size_t(x + reach)] = own[within(x, width)];
        Imf::RgbaYca::reconstructChromaHoriz(width, padded.data(), own);
    }
    std::vector<Imf::Rgba> above(static_cast<std::size_t>(width)), here = above, below = above,
                                                                   result = above;
    row(-1, above);
    row(0, here);
    for (int y = 0; y < height; ++y) {
        row(y + 1, below);
        const std::array<const Imf::Rgba *, 3> rows{above.data(), here.data(), below.data()};
        Imf::RgbaYca::fixSaturation(weights_, width, rows.data(), result.data());
        const Imath::V2i corner = grid_.box().min;
        const std::size_t first = to.index(corner.x, corner.y + y);
        for (std::size_t x = 0; x < result.size(); ++x) {
            planes[0][first + x] = result[x].r;
            planes[1][first + x] = result[x].g;
            planes[2][first + x] = result[x].b;
        }
        std::swap(above, here);
        std::swap(here, below);
    }
}

void LuminanceChroma::row(int y, std::vector<Imf::Rgba> &colours) const {
    std::array<const Imf::Rgba *, Imf::RgbaYca::N> rows;
    for (int k = 0; k < Imf::RgbaYca::N; ++k)
        rows[std::size_t(k)] =
            &pixels_[std::size_t(within(y + k - reach, grid_.height())) * std::size_t(grid_.width())];
    if (y % 2 == 0)
        std::copy_n(rows[std::size_t(reach)], grid_.width(), colours.begin());
    else
        Imf::RgbaYca::reconstructChromaVert(grid_.width(), rows.data(), colours.data());
    Imf::RgbaYca::YCAtoRGBA(weights_, grid_.width(), colours.data(), colours.data());
}

} // namespace sparselens
