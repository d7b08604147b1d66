// Discs of lamps several pixels wide, and the borders between tiles: in a half-hidden disc, and near the lens.
#include "lab/tests/stress/stress.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sparselens::stress {

namespace {

constexpr int tile = 64; // pixels, wide and high
// CoC up to 153 pixels behind focus.
constexpr ThinLens wide_lens{.radius = 1.2, .focal_px = 640, .focus = 5};

// A round lamp before a dim wall. Where the discs of all its pixels overlap, the picture is their light divided by
// their area, plus the wall.
Result disc(int diameter, int coc) {
    constexpr float shine = 200, dim = 0.001f;
    const int size = 2 * (coc + diameter) + 8;
    const double middle = size / 2 + diameter % 2 * 0.5;
    const auto off = [&](int x, int y) { return std::hypot(x + 0.5 - middle, y + 0.5 - middle); };
    double light = 0;
    const Ldi ldi = colour_ldi(size, size, [&](int x, int y) {
        const bool lamp = off(x, y) <= diameter / 2.0;
        if (lamp) light += double(shine - dim);
        return Pixel{{depth_of(wide_lens, coc), lamp ? shine : dim}};
    });
    const Image image = gather(ldi, wide_lens, 0);
    const double expected = double(dim) + light / (std::numbers::pi * coc * coc);
    Result result;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            if (off(x, y) <= coc - diameter / 2.0 - 2)
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
Result half_hidden() {
    constexpr double coc = 20, before = 5, edge = 67;
    const Ldi ldi = colour_ldi(2 * tile, 2 * tile, [&](int x, int y) {
        Pixel samples;
        if (x >= edge) samples.push_back({depth_of(wide_lens, before), 0});
        if (x == tile - 1 && y == tile - 1)
            samples.push_back({depth_of(wide_lens, coc), 1000, 1, 0.5f, 0.5f});
        return samples;
    });
    const Image image = gather(ldi, wide_lens, 0);
    const double shadow = tile + coc / (coc - before) * (edge - tile);
    const auto area_left_of = [&](double x) { return disc_left_of((std::min(x, shadow) - tile) / coc); };
    Result result;
    for (int x = 0; x < 2 * tile; ++x) {
        double column = 0;
        for (int y = 0; y < 2 * tile; ++y) column += double(image.at(0, x, y));
        const double lit = area_left_of(x + 1) - area_left_of(x);
        result.error = std::max(result.error, std::abs(column - 1000 * lit / std::numbers::pi));
    }
    result.error /= 1000 * 2 / (std::numbers::pi * coc);
    return result;
}

// A dark surface at a CoC of about -50, which leans by 0.4 pixels of CoC per pixel, before a ground of radiance 1: the
// radiance that leaks through the surface around the corner of four tiles.
Result near_seam() {
    const Ldi ldi = grey_ldi(2 * tile, 2 * tile, [](int x, int) {
        return Pixel{{depth_of(wide_lens, -50 + 0.4 * (x - tile)), 0}, {depth_of(wide_lens, 100)}};
    });
    const Imath::Box2i corner(Imath::V2i(tile - 4), Imath::V2i(tile + 3));
    return {off_from(gather(ldi, wide_lens, 0), 0, corner, 0)};
}

constexpr const char *claim = "a round lamp's disc against its pixels' light by its area, inside";
constexpr Limit even{
    rounding, "the disc of a pixel is flat inside: what is summed is float (docs/tolerances.md, section 4)"};
constexpr Limit column{1.0 / 32,
                       "a shadow's edge is known by 64 points a pixel, and passes one pixel of a column"};

constexpr Case cases[] = {
    {"lamp_1_coc_30", claim, even, [] { return disc(1, 30); }},
    {"lamp_1_coc_60", claim, even, [] { return disc(1, 60); }},
    {"lamp_1_coc_140", claim, even, [] { return disc(1, 140); }},
    {"lamp_3_coc_30", claim, even, [] { return disc(3, 30); }},
    {"lamp_3_coc_60", claim, even, [] { return disc(3, 60); }},
    {"lamp_3_coc_140", claim, even, [] { return disc(3, 140); }},
    {"lamp_10_coc_30", claim, even, [] { return disc(10, 30); }},
    {"lamp_10_coc_60", claim, even, [] { return disc(10, 60); }},
    {"lamp_10_coc_140", claim, even, [] { return disc(10, 140); }},
    {"lamp_half_hidden", "columns of a lamp's disc over four tiles, half of it hidden by an edge", column,
     half_hidden},
    {"near_seam", "a ground of 1 behind a dark surface near the lens, where four tiles meet", closed,
     near_seam},
};

} // namespace

INSTANTIATE_TEST_SUITE_P(lamps, Stress, testing::ValuesIn(cases), name_of);

} // namespace sparselens::stress
