// Discs of lamps several pixels wide, and the borders between tiles: in a half-hidden disc, and near the lens.
#include "lab/stress/scenes.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace sparselens::lab {

namespace {

using namespace stress;

constexpr int tile = 64;          // pixels, wide and high
constexpr double rounding = 1e-5; // of sums in float (docs/tolerances.md, section 4)

// CoC up to 153 pixels behind focus.
ThinLens wide_lens() { return {.radius = 1.2, .focal_px = 640, .focus = 5}; }

// A round lamp before a dim wall. Where the discs of all its pixels overlap, the picture is their light divided by
// their area, plus the wall.
template <int Diameter, int CoC>
StressResult disc() {
    constexpr float shine = 200, dim = 0.001f;
    const ThinLens lens = wide_lens();
    const int size = 2 * (CoC + Diameter) + 8;
    const double middle = size / 2 + Diameter % 2 * 0.5;
    const auto off = [&](int x, int y) { return std::hypot(x + 0.5 - middle, y + 0.5 - middle); };
    double light = 0;
    const Ldi ldi = colour_ldi(window(size, size), [&](int x, int y) {
        const bool lamp = off(x, y) <= Diameter / 2.0;
        if (lamp) light += double(shine - dim);
        return Pixel{{depth_of(lens, CoC), lamp ? shine : dim}};
    });
    StressResult result;
    const Image image = gather(ldi, lens, result, 0);
    const double expected = double(dim) + light / (std::numbers::pi * CoC * CoC);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            if (off(x, y) <= CoC - Diameter / 2.0 - 2)
                result.error = std::max(result.error, std::abs(double(image.at(0, x, y)) / expected - 1));
    return result;
}

// The area of the unit disc at x < t.
double disc_left_of(double t) {
    t = std::clamp(t, -1.0, 1.0);
    return t * std::sqrt(1 - t * t) + std::asin(t) + std::numbers::pi / 2;
}

// A lamp at the corner of four tiles, and an opaque half plane x >= 67 before it: each column compared with the area of
// the disc outside the half plane's shadow, relative to the brightest column.
StressResult half_hidden() {
    constexpr double coc = 20, before = 5, edge = 67;
    const ThinLens lens = wide_lens();
    const Ldi ldi = colour_ldi(window(2 * tile, 2 * tile), [&](int x, int y) {
        Pixel samples;
        if (x >= edge) samples.push_back({depth_of(lens, before), 0});
        if (x == tile - 1 && y == tile - 1) samples.push_back({depth_of(lens, coc), 1000, 1, 0.5f, 0.5f});
        return samples;
    });
    StressResult result;
    const Image image = gather(ldi, lens, result, 0);
    const double shadow = tile + coc / (coc - before) * (edge - tile);
    for (int x = 0; x < 2 * tile; ++x) {
        double column = 0;
        for (int y = 0; y < 2 * tile; ++y) column += double(image.at(0, x, y));
        const double lit = disc_left_of((std::min(x + 1.0, shadow) - tile) / coc) -
                           disc_left_of((std::min(double(x), shadow) - tile) / coc);
        result.error = std::max(result.error, std::abs(column - 1000 * lit / std::numbers::pi));
    }
    result.error /= 1000 * 2 / (std::numbers::pi * coc);
    return result;
}

// A dark surface at a CoC of about -50, which leans by 0.4 pixels of CoC per pixel, before a ground of radiance 1: the
// radiance that leaks through the surface around the corner of four tiles.
StressResult near_seam() {
    StressResult result;
    const ThinLens lens = wide_lens();
    const Ldi ldi = grey_ldi(window(2 * tile, 2 * tile), [&](int x, int) {
        const double coc = -50 + 0.4 * (x - tile);
        return Pixel{{depth_of(lens, coc), 0}, {depth_of(lens, 100), 1}};
    });
    const Image image = gather(ldi, lens, result, 0);
    for (int y = tile - 4; y < tile + 4; ++y)
        for (int x = tile - 4; x < tile + 4; ++x)
            result.error = std::max(result.error, double(image.at(0, x, y)));
    return result;
}

constexpr const char *even =
    "the disc of a pixel is flat inside: what is summed is float (docs/tolerances.md, section 4)";
constexpr const char *claim = "a round lamp's disc against its pixels' light by its area, inside";

constexpr std::array cases{
    StressCase{"lamp_1_coc_30", claim, rounding, even, disc<1, 30>},
    StressCase{"lamp_1_coc_60", claim, rounding, even, disc<1, 60>},
    StressCase{"lamp_1_coc_140", claim, rounding, even, disc<1, 140>},
    StressCase{"lamp_3_coc_30", claim, rounding, even, disc<3, 30>},
    StressCase{"lamp_3_coc_60", claim, rounding, even, disc<3, 60>},
    StressCase{"lamp_3_coc_140", claim, rounding, even, disc<3, 140>},
    StressCase{"lamp_10_coc_30", claim, rounding, even, disc<10, 30>},
    StressCase{"lamp_10_coc_60", claim, rounding, even, disc<10, 60>},
    StressCase{"lamp_10_coc_140", claim, rounding, even, disc<10, 140>},
    StressCase{"lamp_half_hidden", "columns of a lamp's disc over four tiles, half of it hidden by an edge",
               1.0 / 32, "a shadow's edge is known by 64 points a pixel, and passes one pixel of a column",
               half_hidden},
    StressCase{"near_seam", "a ground of 1 behind a dark surface near the lens, where four tiles meet",
               rounding, "a surface that goes on lets nothing through: what is summed is 0", near_seam},
};

} // namespace

std::span<const StressCase> lamp_stress() { return cases; }

} // namespace sparselens::lab
