#include "view/view_mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr double focal = 400, inf = std::numeric_limits<double>::infinity();
const Windows windows = windows_of_size(200, 100);

Camera camera_at(const Imath::M44d &world_to_camera) {
    Camera camera;
    camera.focal_length_mm = focal;
    camera.sensor_width_mm = windows.display_width();
    camera.world_to_camera = world_to_camera;
    return camera;
}

Camera moved_by(const Imath::V3d &by) { return camera_at(Imath::M44d().setTranslation(-by)); }

Imath::V2d moved(const Camera &from, const Camera &to, const Imath::V2d &p, double z) {
    return camera_motion(from, to, windows)->moved(p, z);
}

void expect_near(const Imath::V2d &a, const Imath::V2d &b) { EXPECT_LT((a - b).length(), 1e-9) << a << b; }

TEST(CameraMotion, OfACameraThatStandsStillIsNone) {
    for (const double z : {0.1, 7.0, inf})
        expect_near(moved(moved_by({1, 2, 3}), moved_by({1, 2, 3}), {20, 90}, z), {20, 90});
}

TEST(CameraMotion, IsParallaxIfTheCameraMovesAside) {
    const Camera from = moved_by({0, 0, 0}), to = moved_by({0.2, 0.1, 0});
    expect_near(moved(from, to, {20, 90}, 8), {20 - focal * 0.2 / 8, 90 + focal * 0.1 / 8}); // y points up
    expect_near(moved(from, to, {20, 90}, inf), {20, 90});
}

TEST(CameraMotion, ScalesIfTheCameraMovesIn) {
    const Camera from = moved_by({0, 0, 0}), to = moved_by({0, 0, 2});
    expect_near(moved(from, to, {120, 30}, 8), {100 + 20 / 0.75, 50 - 20 / 0.75});
    EXPECT_TRUE(std::isnan(moved(from, to, {120, 30}, 1.5).x)); // now behind the camera
}

TEST(CameraMotion, IsTheSameForAllDepthsIfTheCameraTurns) {
    const double angle = 0.1;
    Imath::M44d turned;
    turned.setAxisAngle({0, 1, 0}, angle);
    const Camera from = camera_at({}), to = camera_at(turned);
    const double x = 100 + focal * std::tan(std::atan(-50 / focal) + angle);
    for (const double z : {1.0, inf}) expect_near(moved(from, to, {50, 50}, z), {x, 50});
}

TEST(CameraMotion, KnowsZoomAxisAndPixelAspect) {
    const Camera from = moved_by({0, 0, 0});
    Camera to = from;
    to.focal_length_mm = 2 * focal;
    to.principal_point = Imath::V2d(0.1, 0.05);
    expect_near(moved(from, to, {110, 45}, 3), {100 + 20 + 20, 50 - 10 + 10});
    Windows wide = windows;
    wide.pixel_aspect = 2;
    const Imath::V2d p = camera_motion(from, moved_by({0, 0.1, 0}), wide)->moved({20, 90}, 8);
    expect_near(p, {20, 90 + 2 * focal * 0.1 / 8});
}

TEST(CameraMotion, IsUnknownWithoutMatrixOrFocalLength) {
    Camera camera = moved_by({0, 0, 0}), other = camera;
    other.world_to_camera.reset();
    EXPECT_FALSE(camera_motion(camera, other, windows));
    other = camera;
    other.focal_length_mm.reset();
    EXPECT_FALSE(camera_motion(camera, other, windows));
}

} // namespace
} // namespace sparselens
