#include "base/numbers.h"
#include "deep/flatten.h"
#include "deep/mixed_pixels.h"
#include "deep/view_samples.h"
#include "lens/lens_points.h"
#include "support/views.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

// A premultiplied pixel of this colour.
ViewPixel covered(float z, float a, float r = 1, float g = 1) {
    return {.z = z, .r = a * r, .g = a * g, .a = a};
}

View row_of(const std::vector<ViewPixel> &pixels) {
    return make_view(windows_of_size(int(pixels.size()), 1), {0, 0},
                     [&](int x, int) { return pixels[std::size_t(x)]; });
}

// The depths of a row of pixels after they are settled.
std::vector<float> repaired(const std::vector<ViewPixel> &pixels) {
    View view = row_of(pixels);
    repair_edge_depths(view);
    return view.z;
}

using Depths = std::vector<float>;

TEST(EdgeDepths, APartlyCoveredPixelOfTheSkyTakesTheDepthBesideIt) {
    EXPECT_EQ(repaired({covered(3, 1), covered(inf, 0.4f), covered(inf, 0)}), (Depths{3, 3, inf}));
    EXPECT_EQ(repaired({covered(3, 1), covered(1e9f, 0.4f), covered(inf, 0)}), (Depths{3, 3, inf}));
    EXPECT_EQ(repaired({covered(3, 1), covered(1.2f, 0.4f), covered(inf, 0)}),
              (Depths{3, 3, inf})); // mixed with 0
    EXPECT_EQ(repaired({covered(3, 1), covered(inf, 0.9f), covered(inf, 0.1f), covered(inf, 0)}),
              (Depths{3, 3, 3, inf}));                                           // two pixels away
    EXPECT_EQ(repaired({covered(inf, 0.5f), covered(4, 0.5f)}), (Depths{4, 4})); // a hair: no full pixel
}

TEST(EdgeDepths, TheColourSaysWhichSurfaceItIs) {
    EXPECT_EQ(repaired({covered(3, 1, 1, 0), covered(inf, 0.4f, 1, 0.1f), covered(8, 1, 0, 1)}),
              (Depths{3, 3, 8}));
    EXPECT_EQ(repaired({covered(3, 1, 1, 0), covered(inf, 0.4f, 0.1f, 1), covered(8, 1, 0, 1)}),
              (Depths{3, 8, 8}));
    EXPECT_EQ(repaired({covered(3, 0.5f), covered(inf, 0.4f), covered(8, 1)}),
              (Depths{3, 8, 8})); // else coverage
}

TEST(EdgeDepths, OtherDepthsStay) {
    for (const auto &pixels : std::vector<std::vector<ViewPixel>>{
             {covered(3, 1), covered(inf, 1), covered(inf, 0)},            // an opaque sky
             {covered(3, 1), covered(inf, 0), covered(inf, 0)},            // nothing
             {covered(3, 1), covered(10, 0.5f), covered(inf, 0)},          // a hair behind it
             {covered(3, 1), covered(3.01f, 0.99f), covered(inf, 0)},      // an edge of its own depth
             {covered(inf, 0.5f), covered(inf, 0.4f), covered(inf, 0.5f)}, // smoke in the sky
             {covered(3, 1), covered(inf, 0), covered(inf, 0), covered(inf, 0.5f)}}) { // and beside something
        const View view = row_of(pixels);
        EXPECT_EQ(repaired(pixels), view.z);
    }
}

// Only the first pixel of the row has a depth. Before nothing the row is a strand, and takes that depth up to 10 pixels
// away; otherwise pixels without a depth of their own take it only up to 2 pixels away.
TEST(EdgeDepths, AStrandOverNothingGoesOn) {
    for (const bool nothing : {true, false}) {
        View view = make_view(windows_of_size(14, 2), {0, 0}, [&](int x, int y) {
            return y == 1 && nothing ? covered(inf, 0) : covered(x == 0 ? 3 : inf, 0.4f);
        });
        repair_edge_depths(view);
        const int repaired = nothing ? 10 : 2; // 2 pixels, and 8 more
        for (int x = 0; x < 14; ++x) EXPECT_EQ(view.z[std::size_t(x)], x <= repaired ? 3 : inf) << x;
    }
}

// A filter spreads a low step over five pixels, so that no two neighbours are apart. Steep steps above it show that
// depth is filtered.
TEST(EdgeDepths, LowStepsOfFilteredDepthAreSettledToo) {
    const auto mixed = [](float near, float far, float share) {
        return ViewPixel{.z = share * near + (1 - share) * far, .r = share + 0.2f * (1 - share)};
    };
    View view = make_view(windows_of_size(11, 12), {0, 0}, [&](int x, int y) {
        if (y < 6) return mixed(3, 8, x < 5 ? 1.0f : x == 5 ? 0.6f : 0.0f);
        return mixed(3, 3.4f, x < 4 ? 1.0f : x > 6 ? 0.0f : x == 4 ? 0.75f : x == 5 ? 0.55f : 0.25f);
    });
    repair_edge_depths(view);
    EXPECT_EQ(view.z[view.image.windows.index(Imath::V2i(5, 2))], 3);
    EXPECT_EQ(view.z[view.image.windows.index(Imath::V2i(5, 9))], 3);
}

TEST(EdgeDepths, AnLdiOfOneSampleAPixelIsAView) {
    View view = row_of({covered(3, 1), covered(inf, 0.4f), covered(8, 0.9f)});
    Ldi ldi = ViewSamples(view, view.image.channels).as_ldi();
    EXPECT_EQ(repair_edge_depths(ldi).count, 1u);
    EXPECT_EQ(ldi.z, (Depths{3, 3, 8}));
    EXPECT_EQ(ldi.values[3], (std::vector<float>{1, 0.4f, 0.9f}));
}

// A red disc of radius 8 before a green wall, or the sky; its edge mixes the colours. `depth(share)` gives a pixel's
// depth.
template <typename Depth>
View disc_before_wall(const Depth &depth) {
    return make_view(windows_of_size(32, 32), {0, 0}, [&](int x, int y) {
        int inside = 0;
        for (int k = 0; k < 64; ++k)
            inside += std::hypot(x + (k % 8 + 0.5) / 8 - 16.3, y + (k / 8 + 0.5) / 8 - 15.8) < 8;
        const float share = float(inside) / 64;
        return ViewPixel{.z = depth(share, x, y), .r = share, .g = 1 - share};
    });
}

TEST(EdgeDepths, FilteredDepthBecomesThatOfTheSurfaceShownMost) {
    for (const float wall : {10.0f, 1e10f}) {
        View view = disc_before_wall([&](float share, int, int) {
            return share == 0 && wall == 1e10f ? inf : share * 2 + (1 - share) * wall;
        });
        const RepairedEdges repaired = repair_edge_depths(view);
        EXPECT_GT(repaired.count, 20u);
        EXPECT_TRUE(repaired.filtered);
        for (std::size_t i = 0; i < view.z.size(); ++i) {
            const float share = view.image.plane(0)[i];
            if (share < 0.1f || share > 0.9f || (share > 0.4f && share < 0.6f)) continue;
            EXPECT_EQ(view.z[i], share > 0.5f ? 2 : wall == 1e10f ? inf : wall) << share;
        }
    }
}

// One sample gives each pixel's depth, and a few depths are intermediate by chance: nothing is filtered.
TEST(EdgeDepths, DepthThatIsNotFilteredStays) {
    View view = disc_before_wall([](float share, int x, int y) {
        if (x == 24 && y < 18) return share * 2 + (1 - share) * 10;
        return unit_interval(mix_bits(std::uint32_t(x), std::uint32_t(y))) < double(share) ? 2.0f : 10.0f;
    });
    const std::vector<float> before = view.z;
    const RepairedEdges repaired = repair_edge_depths(view);
    EXPECT_EQ(repaired.count, 0u);
    EXPECT_FALSE(repaired.filtered);
    EXPECT_EQ(view.z, before);
}

TEST(EdgeDepths, ASteepSlopeStays) {
    View view = make_view(windows_of_size(16, 12), {0, 0}, [](int x, int y) {
        return ViewPixel{.z = 2 + float(y) / 6, .r = float(x + 8 * y), .g = 50.0f + float(4 * x - 4 * y)};
    });
    const RepairedEdges repaired = repair_edge_depths(view);
    EXPECT_EQ(repaired.count, 0u);
    EXPECT_FALSE(repaired.filtered);
}

} // namespace
} // namespace sparselens
