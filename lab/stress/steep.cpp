#include "lab/stress/scenes.h"

#include <algorithm>
#include <array>

namespace sparselens::lab {

namespace {

using namespace stress;

constexpr double rounding = 1e-5; // of sums over lens points, in float (docs/tolerances.md, section 4)

// CoC up to 80 pixels behind focus.
ThinLens near_lens() { return {.radius = 0.625, .focal_px = 640, .focus = 5}; }

// A dark plane that leans by this many hundredths of a pixel of CoC per pixel, across and down, before a ground of
// radiance 1: the radiance that leaks through the plane in the middle, where every lens point looks at the plane.
template <int Across, int Down = 0>
StressResult tilted_plane() {
    StressResult result;
    const ThinLens lens = near_lens();
    const Ldi ldi = grey_ldi(window(136, 96), [&](int x, int y) {
        const double coc = std::clamp(Across / 100.0 * (x - 64) + Down / 100.0 * (y - 48), -70.0, 70.0);
        return Pixel{{depth_of(lens, coc), 0}, {depth_of(lens, 79), 1}};
    });
    const Image image = gather(ldi, lens, result, 256);
    for (int y = 40; y < 56; ++y)
        for (int x = 62; x < 68; ++x) result.error = std::max(result.error, double(image.at(0, x, y)));
    return result;
}

// Textured bumps whose sides are up to 1 pixel of CoC per pixel steep, before a ground of radiance 10; the border
// between two tiles runs through them.
StressResult bumps() {
    constexpr double height = 3;
    const ThinLens lens = near_lens();
    return against_reference(
        grey_ldi(window(72, 20),
                 [&](int x, int y) {
                     const double across = std::abs((x % 12) - 5.5) / 6, down = (y - 10.0) / 12;
                     const double bump = 1 - across * across - down * down;
                     const double coc = 5 - height * bump + 0.02 * double(texture(y, x)); // all depths differ
                     return Pixel{{depth_of(lens, coc), texture(x, y)}, {depth_of(lens, 70), 10}};
                 }),
        lens, 16);
}

constexpr const char *closed = "a surface that goes on lets nothing through: what is summed is 0";
constexpr const char *reorders =
    "the kernel only reorders the reference's sums: docs/tolerances.md, section 4";

constexpr std::array cases{
    StressCase{"plane_0.05", "a ground of 1 behind a dark plane of 0.05 px of CoC a pixel", rounding, closed,
               tilted_plane<5>},
    StressCase{"plane_0.24", "a ground of 1 behind a dark plane of 0.24 px of CoC a pixel", rounding, closed,
               tilted_plane<24>},
    StressCase{"plane_askew", "a ground of 1 behind a dark plane of 0.12 px of CoC a pixel and -0.11 down",
               rounding, closed, tilted_plane<12, -11>},
    StressCase{"plane_0.5", "a ground of 1 behind a dark plane of 0.5 px of CoC a pixel", rounding, closed,
               tilted_plane<50>},
    StressCase{"plane_0.9", "a ground of 1 behind a dark plane of 0.9 px of CoC a pixel", rounding, closed,
               tilted_plane<90>},
    StressCase{"bumps", "bumps of up to 1 px of CoC a pixel before a bright ground, against the reference",
               rounding, reorders, bumps},
};

} // namespace

std::span<const StressCase> steep_stress() { return cases; }

} // namespace sparselens::lab
