// The reach of light with looks: closed forms.
#include "lens/psf.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.1, .focal_px = 400, .focus = 5}; // R F / d: 8 px

Windows picture() {
    Windows windows;
    windows.data = windows.display = {{0, 0}, {199, 99}};
    return windows;
}

void expect_reach(const LensLooks &looks, const Imath::V2d &at, double coc, const Imath::V2d &expected) {
    const Imath::V2d reach = LightReach(lens, looks, picture()).at(at, coc);
    EXPECT_NEAR(reach.x, expected.x, 1e-9);
    EXPECT_NEAR(reach.y, expected.y, 1e-9);
}

TEST(LightReach, IsTheDiscOfTheLens) {
    expect_reach({}, {10, 10}, -4, {4, 4});
    expect_reach({.aperture = {.squeeze = 0.5}}, {10, 10}, 4, {8, 4});
    expect_reach({.aperture = {.squeeze = 2}}, {10, 10}, 4, {2, 4});
    expect_reach({.chromatic_coc = {1.5, 0, -2.5}}, {10, 10}, 4, {5.5, 5.5});
    expect_reach({.chromatic_coc = {1.5, 0, -2.5}}, {10, 10}, -4, {6.5, 6.5});
}

// In the corner 1/d is 1 + K times as large; x pixels right of the axis, 1 + tan X x / F.
TEST(LightReach, FollowsThePlaneOfFocus) {
    const Imath::V2d slope = 8 * 0.5 * 2 / 12500.0 * Imath::V2d(100, 50); // of the CoC, in the corner
    expect_reach({.field_curvature = 0.5}, {200, 0}, 3, Imath::V2d(3 + 8 * 0.5) / (1 - slope.length()));
    expect_reach({.astigmatism = -0.5}, {200, 0}, 3, Imath::V2d(3 + 8 * 0.5));
    const double tilt = 0.4, gradient = 8 * tilt / 400;
    expect_reach({.tilt = {tilt, 0}}, {150, 50}, 3, Imath::V2d(1, 1) * (3 + 50 * gradient) / (1 - gradient));
}

TEST(LightReach, MovesWithTheMagnifiedPicture) {
    const LightReach light(lens, {.magnification = 1.25}, picture());
    const Imath::Box2d box = light.box({180, 30}, 4);
    EXPECT_NEAR(box.min.x, 100 + 80 * 1.25 - 5, 1e-9);
    EXPECT_NEAR(box.max.y, 50 - 20 * 1.25 + 5, 1e-9);
    EXPECT_NEAR(light.shown_at({200, 50}).x, 180, 1e-9);
}

} // namespace
} // namespace sparselens
