// The pixels of a flat picture with depth; each pixel is one sample.
#pragma once

#include "../base/channel_kind.h"
#include "base/image.h"
#include "base/light.h"
#include "view.h"
#include "view/view.h"

#include <Imath/ImathVec.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

namespace sparselens {

// Refers to the picture.
struct FlatPixels {
    ArrayGrid grid;                                 // origin at the picture's corner
    std::array<std::span<const float>, 3> rgb = {}; // empty: no such channel
    std::span<const float> alpha = {};              // empty: all are covered
    std::span<const float> z = {};

    float coverage(std::size_t i) const { return alpha.empty() ? 1 : alpha[i]; }
    bool opaque(std::size_t i) const { return is_opaque(coverage(i)); }
    bool have_colours() const { return !rgb[0].empty() && !rgb[1].empty() && !rgb[2].empty(); }
    Imath::V3d colour(std::size_t i) const {
        const auto value = [&](std::size_t k) { return rgb[k].empty() ? 0 : double(rgb[k][i]); };
        return {value(0), value(1), value(2)};
    }
};

// plane(k) returns the values of channel k.
template <typename Plane>
FlatPixels flat_pixels(const Windows &windows, std::span<const Channel> channels, std::span<const float> z,
                       const Plane &plane) {
    const std::array rgb = find_rgb(channels);
    const std::size_t alpha = find_channel(channels, "A");
    FlatPixels pixels{.grid = ArrayGrid(windows.width(), windows.height()), .z = z};
    for (std::size_t k = 0; k < rgb.size(); ++k)
        if (rgb[k] != npos) pixels.rgb[k] = plane(rgb[k]);
    if (alpha != npos) pixels.alpha = plane(alpha);
    return pixels;
}
inline FlatPixels flat_pixels(const View &view) {
    const Image &image = view.image;
    return flat_pixels(image.windows, image.channels, view.z, [&](std::size_t k) { return image.plane(k); });
}

// The difference of two colours relative to their size, in [0, 1] for light that is not negative.
inline double relative_difference(const Imath::V3d &a, const Imath::V3d &b) {
    double off = 0, light = 1e-6; // so that two dark colours do not differ
    for (int k = 0; k < 3; ++k) {
        off += std::abs(a[k] - b[k]);
        light += std::abs(a[k]) + std::abs(b[k]);
    }
    return off / light;
}

// A depth that exceeds neighbouring depths by this factor means that the pixel shows nothing.
inline constexpr float far_beyond = 16;

// Finds speckles: pixels amid a surface that have the depth of the sky.
//
// Where a renderer scatters a ray, in fog, it may write the depth of the sky: pixels of one surface then have, at
// random, the surface's depth or 1e10. Such a pixel takes the depth of the pixels around it if it is opaque, at least
// five of the eight pixels around it are nearer by 16 times or more, and its colour matches theirs, within a quarter
// plus their own differences. This is repeated until no pixel changes, because speckles come in clumps.
//
// Sky that is really seen through a small hole has the colour of the sky, and stays. A picture with hardly any
// speckles, or with more holes and gaps in hair, is left alone: among the pixels that stand alone (seven of the eight
// around them are nearer), one in four must have the colour of those around it, and these must have one depth.

// Replaces the depths of speckles and returns how many. Depths must be above 0 up to inf, colours premultiplied, and
// all values valid (deep/sanitize.h). `planes`: the channels, one value per pixel.
std::size_t repair_speckles(const Windows &windows, std::span<const Channel> channels,
                            std::span<const std::span<const float>> planes, std::span<float> z);
std::size_t repair_speckles(View &view);

// The warning about replaced depths.
std::string speckle_warning(std::size_t repaired);

} // namespace sparselens
