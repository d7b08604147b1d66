#include "dof/false_colour.h"

#include "deep/flatten.h"

#include <Imath/ImathVec.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

using Imath::V3f;

V3f mix(const V3f &a, const V3f &b, float t) { return a + (b - a) * t; }

// Returns an image with colour(i) in each pixel i of the data window.
template <typename Colour>
Image paint(const Windows &windows, const Colour &colour) {
    Image image(windows, rgba_channels());
    for (std::size_t i = 0; i < windows.pixels(); ++i) {
        const V3f rgb = colour(i);
        for (std::size_t k = 0; k < 3; ++k) image.plane(k)[i] = rgb[int(k)];
        image.plane(3)[i] = 1;
    }
    return image;
}

// The brightness of each pixel, tone-mapped: a third of the sum of its R, G and B.
std::vector<float> brightness(const Ldi &ldi) {
    const Image flat = flatten(ldi);
    std::vector<float> sum(ldi.windows.pixels(), 0);
    for (const std::size_t k : find_rgb(flat.channels)) {
        for (std::size_t i = 0; k != npos && i < sum.size(); ++i)
            sum[i] += std::max(0.0f, flat.plane(k)[i]) / 3;
    }
    for (float &value : sum) value = std::isinf(value) ? 1 : value / (1 + value);
    return sum;
}

} // namespace

Image coc_colours(const Ldi &ldi, const ThinLens &lens) {
    const V3f white(1, 1, 1), front(0, 0, 1), behind(1, 0, 0);
    return paint(ldi.windows, [&, coc = front_circles_of_confusion(ldi, lens)](std::size_t i) {
        const float c = coc[i], size = std::abs(c);
        return mix(white, c < 0 ? front : behind, std::isinf(size) ? 1 : size / (size + 8));
    });
}

Image focus_colours(const Ldi &ldi, const ThinLens &lens) {
    return paint(ldi.windows,
                 [coc = front_circles_of_confusion(ldi, lens), grey = brightness(ldi)](std::size_t i) {
                     const float dark = grey[i] / 2;
                     return std::abs(coc[i]) < 1 ? V3f(dark, dark + 0.5f, dark) : V3f(dark, dark, dark);
                 });
}

Image layer_colours(const Ldi &ldi) {
    static const std::array<V3f, 9> palette{V3f(0, 0, 0),    V3f(0.5f, 0.5f, 0.5f), V3f(0, 0, 1),
                                            V3f(0, 1, 1),    V3f(0, 1, 0),          V3f(1, 1, 0),
                                            V3f(1, 0.5f, 0), V3f(1, 0, 0),          V3f(1, 1, 1)};
    return paint(ldi.windows, [&](std::size_t i) {
        return palette[std::min<std::size_t>(ldi.pixel(i).size(), palette.size() - 1)];
    });
}

Image tile_colours(const LensTiles &tiles, const Windows &windows) {
    const V3f few(0, 0, 1), some(0, 1, 0), many(1, 0, 0);
    const auto colour = [&](int points) {
        if (points == 0) return V3f(0, 0, 0);
        const float t = std::clamp((std::log2(float(points)) - 4) / 8, 0.0f, 1.0f); // 16 .. 4096
        return t < 0.5f ? mix(few, some, 2 * t) : mix(some, many, 2 * t - 1);
    };
    const Tiles places(windows.data, tiles.size);
    return paint(windows,
                 [&](std::size_t i) { return colour(tiles.lens_points[places.tile_of(windows.pixel(i))]); });
}

} // namespace sparselens
