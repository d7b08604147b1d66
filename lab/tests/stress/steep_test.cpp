#include "lab/tests/stress/stress.h"

#include <algorithm>
#include <cmath>

namespace sparselens::stress {

namespace {

// CoC up to 80 pixels behind focus.
constexpr ThinLens near_lens{.radius = 0.625, .focal_px = 640, .focus = 5};

// A dark plane that leans by this many hundredths of a pixel of CoC per pixel, across and down, before a ground of
// radiance 1: the radiance that leaks through the plane in the middle, where every lens point looks at the plane.
Result tilted_plane(int across, int down = 0) {
    const Ldi ldi = grey_ldi(136, 96, [&](int x, int y) {
        const double coc = std::clamp(across / 100.0 * (x - 64) + down / 100.0 * (y - 48), -70.0, 70.0);
        return Pixel{{depth_of(near_lens, coc), 0}, {depth_of(near_lens, 79)}};
    });
    return {off_from(gather(ldi, near_lens, 256), 0, {{62, 40}, {67, 55}}, 0)};
}

// Textured bumps whose sides are up to 1 pixel of CoC per pixel steep, before a ground of radiance 10; the border
// between two tiles runs through them.
Result bumps() {
    return against_reference(
        grey_ldi(72, 20,
                 [](int x, int y) {
                     const double across = std::abs((x % 12) - 5.5) / 6, down = (y - 10.0) / 12;
                     const double bump = 1 - across * across - down * down;
                     const double coc = 5 - 3 * bump + 0.02 * double(texture(y, x)); // all depths differ
                     return Pixel{{depth_of(near_lens, coc), texture(x, y)}, {depth_of(near_lens, 70), 10}};
                 }),
        near_lens, 16);
}

constexpr Case cases[] = {
    {"plane_0.05", "a ground of 1 behind a dark plane of 0.05 px of CoC a pixel", closed,
     [] { return tilted_plane(5); }},
    {"plane_0.24", "a ground of 1 behind a dark plane of 0.24 px of CoC a pixel", closed,
     [] { return tilted_plane(24); }},
    {"plane_askew", "a ground of 1 behind a dark plane of 0.12 px of CoC a pixel and -0.11 down", closed,
     [] { return tilted_plane(12, -11); }},
    {"plane_0.5", "a ground of 1 behind a dark plane of 0.5 px of CoC a pixel", closed,
     [] { return tilted_plane(50); }},
    {"plane_0.9", "a ground of 1 behind a dark plane of 0.9 px of CoC a pixel", closed,
     [] { return tilted_plane(90); }},
    {"bumps", "bumps of up to 1 px of CoC a pixel before a bright ground, against the reference", reorders,
     bumps},
};

} // namespace

INSTANTIATE_TEST_SUITE_P(steep, Stress, testing::ValuesIn(cases), name_of);

} // namespace sparselens::stress
