// The overscan that a picture needs: closed forms for one plane.
#include "dof/border_reach.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

// A grey plane of CoC c, with a lamp in one pixel, over a display window of 40 x 30 with `overscan` pixels of overscan.
Ldi plane(double c, int overscan, const Imath::V2i &lamp = {20, 15}) {
    Windows windows = windows_of_size(40, 30);
    windows.data.min -= Imath::V2i(overscan);
    windows.data.max += Imath::V2i(overscan);
    return make_ldi(windows, rgba_channels(), [&](int x, int y) {
        const float light = Imath::V2i(x, y) == lamp ? 50.0f : 0.5f;
        return std::vector<Sample>{{depth_of(lens, c), {light, light, light, 1}}};
    });
}

// Squeezed to 1/2, the lens is twice as wide. Colours spread by their own CoC. A picture magnified by 1.1 needs 1.3 of
// 15 rows less above and below.
TEST(BorderReach, IsUpToTheLooks) {
    const auto needed = [](const LensLooks &looks) {
        return border_reach(plane(4.7, 0), lens, looks).needed;
    };
    EXPECT_EQ(needed({.aperture = {.squeeze = 0.5}}), 10);
    EXPECT_EQ(needed({.chromatic_coc = {-1.2, 0, 1.2}}), 6);
    EXPECT_EQ(needed({.magnification = 1.1}), 4);
    EXPECT_GT(needed({.field_curvature = 0.5}), 8); // 7.7 / 2 pixels more in the corner
    EXPECT_GT(needed({.tilt = {3, 0}}), 5);
}

TEST(BorderReach, IsTheLargestBlurAtTheBorder) {
    for (const double c : {-12.3, -0.2, 4.7}) {
        const BorderReach reach = border_reach(plane(c, 0), lens);
        EXPECT_EQ(reach.needed, int(std::ceil(std::abs(c)))) << c;
        EXPECT_EQ(reach.rendered, 0);
        EXPECT_TRUE(reach.too_little());
    }
    EXPECT_EQ(border_reach(plane(4.7, 5), lens).rendered, 5);
    EXPECT_FALSE(border_reach(plane(4.7, 5), lens).too_little());
}

TEST(BorderReach, FindsLampsAtTheBorderThatAreDiscs) {
    EXPECT_FALSE(border_reach(plane(4.7, 0), lens).bright);
    EXPECT_TRUE(border_reach(plane(4.7, 0, {0, 7}), lens).bright);
    EXPECT_FALSE(border_reach(plane(0.5, 0, {0, 7}), lens).bright);
}

// With pixels twice as wide as high, a disc 4.7 pixels across is 9.4 pixels high.
TEST(BorderReach, IsAskedOfEachSideByItself) {
    Ldi wide = plane(4.7, 10);
    ThinLens high = lens;
    wide.windows.pixel_aspect = 2;
    high.pixel_aspect = 2;
    EXPECT_FALSE(border_reach(wide, high).too_little());
    EXPECT_EQ(border_reach(wide, high).needed, 10);
    wide.windows.display.min.x -= 5; // 5 pixels there
    EXPECT_FALSE(border_reach(wide, high).too_little());
    wide.windows.display.max.y += 3; // 7 pixels below
    const BorderReach reach = border_reach(wide, high);
    EXPECT_TRUE(reach.too_little());
    EXPECT_EQ(reach.needed, 10);
    EXPECT_EQ(reach.rendered, 7);
    wide.windows.display.min.x -= 1; // 4 pixels there, 5 needed: less is missing than below
    EXPECT_EQ(border_reach(wide, high).rendered, 7);
    wide.windows.display.max.y -= 3;
    EXPECT_EQ(border_reach(wide, high).rendered, 4);
}

TEST(BorderReach, OfAnElementThatDoesNotFillTheFrameIsNothing) {
    Ldi element = plane(12, 0);
    element.windows.display.max += Imath::V2i(10);
    EXPECT_FALSE(border_reach(element, lens).too_little());
}

} // namespace
} // namespace sparselens
