// Pictures in closed form for the tests of src/match.
#pragma once

#include "base/image.h"
#include "match/blocks.h"
#include "match/lens_search.h"

#include <cmath>

namespace sparselens::test {

inline std::vector<std::uint8_t> all_usable(const Grid &grid) {
    return std::vector<std::uint8_t>(grid.size(), 1);
}

// The value of each pixel by value(x, y, channel).
template <typename Value>
Rgb colours(int width, int height, const Value &value) {
    Rgb of{windows_of_size(width, height).grid(), {}};
    for (std::size_t k = 0; k < 3; ++k)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) of.rgb[k].push_back(float(value(double(x), double(y), k)));
    return of;
}

// Waves in each channel, of different directions; `keeps(x, w)` is the share of a wave of w radians per pixel that is
// left at x.
template <typename Keeps>
Rgb waves(int width, int height, const Keeps &keeps) {
    return colours(width, height, [&](double x, double y, std::size_t k) {
        const double u = 0.35 + 0.13 * double(k), v = 0.3 - 0.21 * double(k), turn = 0.6 + 0.4 * double(k);
        return 0.4 + 0.12 * keeps(x, std::hypot(u, v)) * std::sin(u * x + v * y) +
               0.12 * keeps(x, turn) * std::sin(turn * (x - 0.7 * y) / std::hypot(1.0, 0.7) + double(k));
    });
}
inline Rgb waves(int width, int height) {
    return waves(width, height, [](double, double) { return 1.0; });
}

// A scene whose disparity falls from 12 at the left to 2 at the right. Its lens blurs by Gaussians, so the blur
// of a wave is known in closed form.
inline double depth_at(double x, int width) { return 12 - 10 * x / width; }
inline Rgb blurred_waves(int width, int height, double coc, double scale) {
    return waves(width, height, [=](double x, double w) {
        const double c = coc - scale * (depth_at(x, width) - 7);
        return std::exp(-w * w * c * c / 8); // a disc of radius c has the variance c^2 / 4
    });
}

inline Comparison slope_before(const Rgb &plate) {
    const int width = plate.grid.width(), height = plate.grid.height();
    Comparison pictures;
    pictures.colours = tone_mapped(plate);
    pictures.plate = brightness(pictures.colours);
    pictures.usable = all_usable(plate.grid);
    pictures.near = 12;
    pictures.middle = 7;
    pictures.far = 2;
    pictures.gather = [=](double coc, double scale, bool) {
        return blurred_waves(width, height, coc, scale);
    };
    return pictures;
}

} // namespace sparselens::test
