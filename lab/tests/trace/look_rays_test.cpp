// The directions of the reference's rays through a lens with looks, in closed form.
#include "lab/trace/look_rays.h"

#include <gtest/gtest.h>

#include <vector>

namespace sparselens::lab {
namespace {

RenderSettings settings_with(const LensLooks &looks) {
    RenderSettings settings;
    settings.windows = windows_of_size(96, 64);
    settings.lens = {.radius = 0.06, .focal_px = 640, .focus = 5};
    settings.looks = looks;
    return settings;
}

// The ray's position at this depth.
Imath::V3d at_depth(const Ray &ray, double z) {
    return ray.origin + ray.direction * ((z - ray.origin.z) / ray.direction.z);
}

// The rays of a pixel at x right, y up of the axis must meet on the ray through the middle of the lens at depth z.
void expect_to_meet(const LensLooks &looks, double x, double y, double z, std::size_t colour = 1,
                    const std::vector<Imath::V2d> &points = {{1, 0}, {-1, 0}, {0, 1}, {0.6, -0.8}, {0, 0}}) {
    const RenderSettings settings = settings_with(looks);
    const LookRays rays(settings);
    const Imath::V2d p(48 + x, 32 - y);
    const Imath::V3d expected(x / 640 * z, y / 640 * z, z);
    for (const Imath::V2d &u : points) {
        const Ray ray = rays.ray(u, p, rays.inverse_focus(p, colour), 0.5);
        EXPECT_LT((at_depth(ray, z) - expected).length(), 1e-12) << "x " << x << ", y " << y << ", u " << u;
    }
}

constexpr Imath::V2d places[] = {{0, 0}, {40, 0}, {-40, 0}, {0, 25}, {0, -25}, {30, -20}};

TEST(LookRays, MeetOnThePlaneOfFocus) {
    for (const Imath::V2d &p : places) expect_to_meet({}, p.x, p.y, 5);
}

// Rays meet on the plane z + x tan X + y tan Y = d.
TEST(LookRays, MeetOnATiltedPlane) {
    for (const Imath::V2d &p : places)
        expect_to_meet({.tilt = {2, -1}}, p.x, p.y, 5 / (1 + 2 * p.x / 640 - p.y / 640));
}

// 1/z = (1 + K rho^2) / d; in the corner, half a diagonal from the axis, rho is 1.
TEST(LookRays, MeetOnABentSurface) {
    expect_to_meet({.field_curvature = 0.4}, 48, 32, 5 / 1.4);
    expect_to_meet({.field_curvature = 0.4}, -24, 16, 5 / 1.1);
    expect_to_meet({.field_curvature = -0.4}, 48, -32, 5 / 0.6);
}

// Rays along the line to the axis, and across it: 1/z = (1 + A rho^2) / d, and (1 - A rho^2) / d.
TEST(LookRays, MeetTwiceWithAstigmatism) {
    const Imath::V2d along = Imath::V2d(48, 32).normalized(), across(-along.y, along.x);
    expect_to_meet({.astigmatism = 0.4}, 48, 32, 5 / 1.4, 1, {along, -along, along / 2});
    expect_to_meet({.astigmatism = 0.4}, 48, 32, 5 / 0.6, 1, {across, -across});
    expect_to_meet({.astigmatism = -0.4}, 24, -16, 5 / 0.9, 1, {{along.x, -along.y}});
}

// c = R F (1/d - 1/z), so for a colour whose CoC grows by s the sharp depth has 1/z = 1/d + s / (R F).
TEST(LookRays, MeetWhereTheirColourComesToFocus) {
    for (std::size_t colour = 0; colour < 3; ++colour)
        expect_to_meet({.chromatic_coc = {-2, 0, 3}}, 30, -20,
                       1 / (1 / 5.0 + std::array{-2.0, 0.0, 3.0}[colour] / (0.06 * 640)), colour);
}

} // namespace
} // namespace sparselens::lab
