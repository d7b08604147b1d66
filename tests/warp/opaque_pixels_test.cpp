// Opaque parts of the views pass no light in the LDI or through a lens; other parts do.
#include "deep/flatten.h"
#include "dof/methods.h"
#include "lens/lens_samples.h"
#include "support/mattes.h"
#include "warp/coverage.h"
#include "warp/warp_fixture.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

using namespace warping;

constexpr double tolerance = 0.05; // in 1 / z: 2, 4 and 10 are different surfaces

ViewPixel red_at_2(int, int) { return {.z = 2, .r = 0.8f}; }
ViewPixel green_at_10(int, int) { return {.z = 10, .g = 0.6f}; }
ViewPixel half_red_at_2(int, int) { return {.z = 2, .r = 0.4f, .a = 0.5f}; }

using Pixels = ViewPixel (*)(int, int);

// The middle pixel of an LDI with these samples, 6 pixels wider on each side than its views, which are all at the
// middle of the lens and show the same in every pixel.
TestPixel kept_opaque(const TestPixel &samples, const std::vector<Pixels> &pixels, int x = 2) {
    std::vector<View> views;
    for (const Pixels show : pixels) {
        const bool centre = views.empty();
        const Imath::Box2i data(Imath::V2i(centre ? 0 : -6), Imath::V2i(centre ? 4 : 10));
        views.push_back(make_view({Imath::Box2i({0, 0}, {4, 4}), data}, {0, 0}, show));
    }
    const ReprojectedViews reprojected(views, 100, 1, 0);
    Ldi ldi = make_ldi({views[0].image.windows.display, Imath::Box2i(Imath::V2i(-6), Imath::V2i(10))},
                       rgba_channels(), [&](int u, int v) {
                           std::vector<Sample> found;
                           for (const TestSample &s : samples)
                               if (u == x && v == 2)
                                   found.push_back({double(s.z), {s.colour, 0, 0, s.alpha}, s.dx, s.dy});
                           return found;
                       });
    keep_opaque(reprojected, tolerance, ldi);
    TestPixel result;
    for (const std::uint64_t i : ldi.pixel(ldi.windows.index(Imath::V2i(x, 2))))
        result.push_back({ldi.z[i], ldi.values[0][i] + 10 * ldi.values[1][i], ldi.values[3][i]});
    return result;
}

constexpr int beyond_the_frame = 7;

TEST(OpaquePixels, ASurfaceThatAllViewsSeeKeepsItsColour) {
    for (const int x : {2, beyond_the_frame}) {
        const TestPixel pixel =
            kept_opaque({{.z = 2, .colour = 0.3f, .alpha = 0.75f}}, {red_at_2, red_at_2, red_at_2}, x);
        EXPECT_EQ(pixel[0].alpha, 1);
        EXPECT_FLOAT_EQ(pixel[0].colour, 0.4f);
        EXPECT_EQ(pixel[0].z, 2);
    }
}

// Three of four views look past it: it does not grow, and the surface behind fills the pixel up.
TEST(OpaquePixels, WhatIsSeenPastASurfaceFillsItUp) {
    for (const int x : {2, beyond_the_frame}) {
        const TestPixel pixel =
            kept_opaque({{.z = 2, .colour = 0.2f, .alpha = 0.25f}},
                        {green_at_10, red_at_2, green_at_10, green_at_10, green_at_10}, x);
        EXPECT_EQ(pixel[0].alpha, 1);
        EXPECT_FLOAT_EQ(pixel[0].colour, 0.2f + 10 * 0.75f * 0.6f);
        EXPECT_EQ(pixel[0].z, 2);
    }
}

TEST(OpaquePixels, TheLastSampleAloneIsFilledUp) {
    const TestPixel pixel =
        kept_opaque({{.z = 2, .colour = 0.1f, .alpha = 0.5f}, {.z = 4, .colour = 0.2f, .alpha = 0.5f}},
                    {red_at_2, red_at_2});
    EXPECT_EQ(pixel[0].alpha, 0.5f);
    EXPECT_EQ(pixel[0].colour, 0.1f);
    EXPECT_EQ(pixel[1].alpha, 1);
    EXPECT_FLOAT_EQ(pixel[1].colour, 0.4f); // no view looks past it
}

// It keeps the coverage from the views' vote: nothing shows through it while something opaque is in front.
TEST(OpaquePixels, WhatLiesBehindSomethingOpaqueStays) {
    const TestPixel pixel =
        kept_opaque({{.z = 2, .colour = 0.8f, .alpha = 1}, {.z = 4, .colour = 0.2f, .alpha = 0.5f}},
                    {red_at_2, green_at_10});
    EXPECT_EQ(pixel[1].alpha, 0.5f);
    EXPECT_EQ(pixel[1].colour, 0.2f);
}

// Inside the frame the centre view decides whether a pixel is opaque. Inside and beyond, pixels that rim views look
// through stay open.
TEST(OpaquePixels, WhatIsTransparentInTheViewsStays) {
    const TestPixel half{{.z = 2, .colour = 0.4f, .alpha = 0.5f}};
    const auto alpha = [&](const std::vector<Pixels> &views, int x) {
        return kept_opaque(half, views, x)[0].alpha;
    };
    EXPECT_EQ(alpha({half_red_at_2, red_at_2, red_at_2}, 2), 0.5f);
    EXPECT_EQ(alpha({red_at_2, half_red_at_2, red_at_2}, 2), 0.5f);
    EXPECT_FLOAT_EQ(alpha({red_at_2, half_red_at_2, green_at_10, red_at_2}, 2), 0.5f + 0.5f * 2 / 3);
    EXPECT_EQ(alpha({red_at_2, half_red_at_2, red_at_2}, beyond_the_frame), 0.5f);
    EXPECT_EQ(alpha({half_red_at_2, red_at_2, red_at_2}, beyond_the_frame), 1);
    EXPECT_EQ(alpha({red_at_2}, beyond_the_frame), 0.5f); // no view looks there
}

} // namespace
} // namespace sparselens
