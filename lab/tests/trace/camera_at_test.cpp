#include "lab/tests/trace/small_scenes.h"
#include "lab/trace/camera_at.h"

#include <gtest/gtest.h>

namespace sparselens::lab {
namespace {

// The file's matrices project a point of the world to where the tracer's own ray `ray` through the pixel p sees it.
// Returns the point as the camera sees it.
Imath::V3d expect_projected(const Camera &camera, const Ray &ray, const Imath::V2d &p) {
    const Imath::V3d point = ray.origin + 7.0 * ray.direction;
    Imath::V3d ndc, local;
    camera.world_to_ndc->multVecMatrix(point, ndc);
    EXPECT_NEAR(ndc.x, p.x / 320, 1e-12);
    EXPECT_NEAR(ndc.y, p.y / 180, 1e-12);
    camera.world_to_camera->multVecMatrix(point, local);
    EXPECT_NEAR(local.z, 7, 1e-12);
    return local;
}

TEST(CameraAt, MatricesAgreeWithTheRays) {
    Camera camera = build_scene("fence").camera;
    camera.focal_length_mm = 50;
    RenderSettings settings = settings_of_size(320, 180);
    settings.lens.focal_px = 320 * 50.0 / 36;
    const Imath::V2d u(-0.4, 0.8), p(70.25, 33.5);
    const Camera moved = camera_at(camera, settings.windows, settings.lens.radius * u);
    const Ray ray = view_ray(settings, u, p);
    const Imath::V3d local = expect_projected(moved, ray, p);
    EXPECT_NEAR(local.x, 7 * ray.direction.x, 1e-12);
    EXPECT_NEAR(local.y, 7 * ray.direction.y, 1e-12);
}

// The same when the camera has moved, at any time of the shutter.
TEST(CameraAt, MatricesFollowTheCamera) {
    const Camera camera = build_scene("fair").camera;
    RenderSettings settings = settings_of_size(320, 180);
    settings.camera =
        displaced({.path = {{0, 0, 0}, {0.1, 0.3, 0.2}}, .turn = 0.4, .axis = {0, 1, 0}}, {0, 0, 2});
    const Imath::V2d u(-0.4, 0.8), p(70.25, 33.5);
    for (const double time : {0.0, 0.3, 1.0}) {
        const Placement placement(settings.camera, time);
        const Camera moved = camera_at(camera, settings.windows, settings.lens.radius * u, placement);
        const Ray ray = view_ray(settings, u, p, time);
        expect_projected(moved, ray, p);
        const auto position =
            position_relative_to(camera_at(camera, settings.windows, {0, 0}, placement), moved, "view");
        ASSERT_TRUE(position);
        EXPECT_LT((*position - settings.lens.radius * Imath::V3d(u.x, u.y, 0)).length(), 1e-12);
    }
}

TEST(CameraAt, PositionIsTheLensPoint) {
    const Camera camera = build_scene("fence").camera;
    const Windows windows = windows_of_size(64, 36);
    const Camera centre = camera_at(camera, windows, {0, 0}),
                 moved = camera_at(camera, windows, {0.06, -0.03});
    const auto position = position_relative_to(centre, moved, "view");
    ASSERT_TRUE(position);
    EXPECT_LT((*position - Imath::V3d(0.06, -0.03, 0)).length(), 1e-12);
    EXPECT_EQ(moved.fstop, camera.fstop);
    EXPECT_EQ(moved.focus_distance, camera.focus_distance);
}

} // namespace
} // namespace sparselens::lab
