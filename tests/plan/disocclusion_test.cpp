#include "plan/disocclusion.h"
#include "support/views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
const ThinLens lens{
    .radius = 0.1, .focal_px = 100, .focus = 5}; // R F = 10 px: a step of 1 at z = 10, of 5 at z = 2
const Windows window = windows_of_size(60, 20);

MovedDepth moved(const std::function<float(int x, int y)> &z, const Imath::V2d &u = {1, 0}) {
    std::vector<float> depth;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 60; ++x) depth.push_back(z(x, y));
    return move_depth(window, depth, lens, u);
}

std::string row(const PixelMask &mask, int y) {
    std::string text;
    for (int x = mask.data.min.x; x <= mask.data.max.x; ++x) text += mask.at(Imath::V2i(x, y)) ? '#' : '.';
    return text;
}

// A card in pixels 20 to 29 at z = 2 before a wall at z = 10: from the right it moves 5 px to the left, the wall 1. The
// uncovered area is 4 px wide, to the right of the card.
TEST(Disocclusion, WhatOpensBesideACard) {
    const MovedDepth from_right = moved([](int x, int) { return x >= 20 && x < 30 ? 2.0f : 10.0f; });
    for (int y = 0; y < 20; ++y)
        EXPECT_EQ(row(disoccluded(from_right), y), std::string(25, '.') + "####" + std::string(31, '.'));
    const MovedDepth from_left = moved([](int x, int) { return x >= 20 && x < 30 ? 2.0f : 10.0f; }, {-1, 0});
    EXPECT_EQ(row(disoccluded(from_left), 7), std::string(21, '.') + "####" + std::string(35, '.'));
    const MovedDepth from_above = moved([](int, int y) { return y >= 8 && y < 12 ? 2.0f : 10.0f; }, {0, 1});
    // u.y points up and y down: the bar moves down by 5 px, the wall by 1.
    for (int y = 0; y < 20; ++y)
        EXPECT_EQ(disoccluded(from_above).at(Imath::V2i(30, y)), y >= 9 && y < 13) << y;
}

// A card at the lens itself leaves the picture, whatever its disparity.
TEST(Disocclusion, WhatIsAtTheLensLeavesThePicture) {
    for (const float near : {1e-3f, 1e-9f, 1e-30f})
        for (const Imath::V2d &u :
             {Imath::V2d(1, 0), Imath::V2d(-1, 0), Imath::V2d(0, 1), Imath::V2d(0, -1)}) {
            const auto z = [&](int x, int y) { return x >= 20 && x < 30 && y >= 8 && y < 12 ? near : 10.0f; };
            EXPECT_TRUE(disoccluded(moved(z, u)).at(Imath::V2i(25, 10))) << near << u;
        }
}

// A wire in column 30 moves away by 5 px and the wall by 1: it hid one column, which is a slit.
TEST(Disocclusion, WhatAWireHides) {
    const PixelMask hidden = disoccluded(moved([](int x, int) { return x == 30 ? 2.0f : 10.0f; }));
    for (int y = 0; y < 20; ++y) EXPECT_EQ(row(hidden, y), std::string(29, '.') + "#" + std::string(30, '.'));
    EXPECT_EQ(without_slits(hidden).count(), 0u);
    const PixelMask wider = disoccluded(moved([](int x, int) { return x == 30 || x == 31 ? 2.0f : 10.0f; }));
    EXPECT_EQ(without_slits(wider).set, wider.set);
}

// One surface has no cracks at any slant, bend or depth.
TEST(Disocclusion, OneSurfaceHidesNothing) {
    const std::vector<std::function<float(int, int)>> surfaces{
        [](int, int) { return 3.7f; }, [](int, int) { return inf; },
        [](int x, int) { return 10 / (0.9f + 0.08f * float(x)); },
        [](int x, int y) { return 10 / (0.9f + 0.05f * float(x) + 0.06f * float(y)); },
        [](int x, int y) { return 10 / (4 + 2 * std::sin(0.3f * float(x)) * std::cos(0.2f * float(y))); }};
    for (const auto &surface : surfaces)
        for (int k = 0; k < 16; ++k) {
            const Imath::V2d u(std::cos(0.4 * k), std::sin(0.4 * k));
            EXPECT_EQ(disoccluded(moved(surface, u)).count(), 0u) << k;
        }
}

// From the right, pixels at the right edge show what is beyond the centre view's frame.
TEST(Disocclusion, BeyondTheFrame) {
    const MovedDepth wall = moved([](int, int) { return 2.0f; });
    EXPECT_EQ(row(unseen_by_centre(wall), 3).substr(0, 54), std::string(54, '.'));
    EXPECT_EQ(row(unseen_by_centre(wall), 3).substr(56), "####");
    EXPECT_EQ(row(wall.edge, 3), std::string(55, '.') + "#####");
    // Sky does not move, but an object near the edge may have a neighbour beyond the frame.
    const MovedDepth sky = moved([](int, int y) { return y < 10 ? inf : 2.0f; });
    EXPECT_EQ(row(unseen_by_centre(sky), 3), std::string(60, '.'));
    EXPECT_EQ(row(sky.edge, 3), std::string(55, '.') + "#####");
}

TEST(Disocclusion, GrowingIsByWholeBoxes) {
    PixelMask mask(Imath::Box2i({-5, -5}, {5, 5}));
    mask.set[mask.index(Imath::V2i(-1, 2))] = 1;
    mask.set[mask.index(Imath::V2i(5, -5))] = 1;
    const PixelMask big = grown(mask, 2);
    for (int y = -5; y <= 5; ++y)
        for (int x = -5; x <= 5; ++x) {
            const bool near_first = std::max(std::abs(x + 1), std::abs(y - 2)) <= 2;
            const bool near_second = std::max(std::abs(x - 5), std::abs(y + 5)) <= 2;
            EXPECT_EQ(big.at(Imath::V2i(x, y)), near_first || near_second) << x << ' ' << y;
        }
    EXPECT_EQ(grown(mask, 0).set, mask.set);
}

} // namespace
} // namespace sparselens
