#include "base/numbers.h"
#include "plan/disocclusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace sparselens {
namespace {

PixelMask mask_of(const std::function<bool(int x, int y)> &set) {
    PixelMask mask(Imath::Box2i({-10, 5}, {309, 204}));
    for (int y = 5; y <= 204; ++y)
        for (int x = -10; x <= 309; ++x) mask.set[mask.index(Imath::V2i(x, y))] = set(x, y);
    return mask;
}

bool covered(const std::vector<Imath::Box2i> &boxes, int x, int y) {
    return std::ranges::any_of(boxes,
                               [&](const Imath::Box2i &box) { return box.intersects(Imath::V2i(x, y)); });
}

TEST(Rectangles, NothingAskedForNothingGiven) {
    EXPECT_TRUE(rectangles_over(mask_of([](int, int) { return false; })).empty());
}

TEST(Rectangles, ARectangleIsItself) {
    const Imath::Box2i box({17, 33}, {140, 121});
    EXPECT_EQ(rectangles_over(mask_of([&](int x, int y) { return box.intersects(Imath::V2i(x, y)); })),
              std::vector{box});
}

TEST(Rectangles, FarThingsStayApart) {
    const auto boxes = rectangles_over(mask_of([](int x, int) { return x == 0 || x == 250; }));
    EXPECT_EQ(boxes, (std::vector{Imath::Box2i({0, 5}, {0, 204}), Imath::Box2i({250, 5}, {250, 204})}));
}

// All requested pixels are covered, and joining wastes a bounded number.
TEST(Rectangles, HoldAllThatIsAskedFor) {
    const auto patterns = {
        mask_of([](int x, int y) { return std::hypot(x - 100, y - 100) < 60; }),
        mask_of([](int x, int y) { return std::abs(x - y) < 3; }),
        mask_of([](int x, int y) { return x * 7919 % 101 == 0 && y * 104729 % 89 == 0; }),
        mask_of([](int, int) { return true; }),
    };
    for (const PixelMask &mask : patterns) {
        const auto boxes = rectangles_over(mask);
        EXPECT_LE(boxes.size(), 64u);
        for (int y = 5; y <= 204; ++y)
            for (int x = -10; x <= 309; ++x) EXPECT_TRUE(!mask.at(Imath::V2i(x, y)) || covered(boxes, x, y));
        for (const Imath::Box2i &box : boxes) {
            EXPECT_TRUE(mask.data.intersects(box.min));
            EXPECT_TRUE(mask.data.intersects(box.max));
        }
    }
    EXPECT_LE(rectangles_over(*patterns.begin(), 5).size(), 5u);
}

} // namespace
} // namespace sparselens
