#include "base/error.h"
#include "support/scratch_folder.h"
#include "view/view.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sparselens {
namespace {

const Imath::V3d origin(0, 0, 0);

Camera camera_with(const Imath::M44d &world_to_camera) {
    Camera camera;
    camera.world_to_camera = world_to_camera;
    return camera;
}

Camera camera_at(const Imath::V3d &position, const Imath::M44d &turn = {}) {
    Imath::M44d move;
    move.setTranslation(-position);
    return camera_with(move * turn);
}

TEST(FocalLength, SpansTheDisplayWindow) {
    Camera camera;
    EXPECT_FALSE(focal_length_px(camera, 640));
    camera.focal_length_mm = 50;
    EXPECT_FALSE(focal_length_px(camera, 640));
    camera.sensor_width_mm = 25;
    EXPECT_EQ(focal_length_px(camera, 640), 1280);
    camera.focal_length_mm.reset();
    EXPECT_FALSE(focal_length_px(camera, 640));
}

TEST(PositionRelativeTo, IsInTheAxesOfTheCentre) {
    const auto position = position_relative_to(camera_at({1, 2, 3}), camera_at({1.5, 1, 3.25}), "view");
    ASSERT_TRUE(position);
    EXPECT_DOUBLE_EQ(position->x, 0.5);
    EXPECT_DOUBLE_EQ(position->y, -1);
    EXPECT_DOUBLE_EQ(position->z, 0.25);
}

TEST(PositionRelativeTo, FollowsCamerasThatAreTurnedAlike) {
    Imath::M44d quarter; // the camera's right is the world's up
    quarter.rotate(Imath::V3d(0, 0, -std::acos(-1.0) / 2));
    const auto position =
        position_relative_to(camera_at({5, 5, 5}, quarter), camera_at({5, 6, 5}, quarter), "view");
    ASSERT_TRUE(position);
    EXPECT_NEAR(position->x, 1, 1e-12);
    EXPECT_NEAR(position->y, 0, 1e-12);
}

TEST(PositionRelativeTo, IsUnknownWithoutBothMatrices) {
    EXPECT_FALSE(position_relative_to({}, camera_at({0, 0, 0}), "view"));
    EXPECT_FALSE(position_relative_to(camera_at({0, 0, 0}), {}, "view"));
}

TEST(PositionRelativeTo, TurnedOrScaledCamerasAreAnErrorThatNamesTheView) {
    Imath::M44d turn;
    turn.rotate(Imath::V3d(0, 0.01, 0));
    EXPECT_NE(what_of<Error>([&] {
                  position_relative_to(camera_at(origin), camera_at(origin, turn), "left.exr");
              }).find("left.exr: worldToCamera is turned"),
              std::string::npos);
    Imath::M44d twice;
    twice.setScale(2);
    EXPECT_THROW(position_relative_to(camera_at(origin), camera_at(origin, twice), "v"), Error);
    const Camera flat = camera_with(Imath::M44d(0.0));
    EXPECT_NE(what_of<Error>([&] {
                  position_relative_to(camera_at(origin), flat, "left.exr");
              }).find("left.exr: worldToCamera cannot be inverted"),
              std::string::npos);
}

// Matrices are stored as float: rounding is not a rotation.
TEST(PositionRelativeTo, AxesMayDifferByTheRoundingOfFloat) {
    Imath::M44d turn;
    turn.rotate(Imath::V3d(0.3, 0.4, 0.5));
    const auto rounded = [&](const Imath::V3d &at) {
        return camera_with(Imath::M44d(Imath::M44f(*camera_at(at, turn).world_to_camera)));
    };
    const auto position = position_relative_to(rounded({100, 200, 300}), rounded({100, 200, 300.5}), "view");
    ASSERT_TRUE(position);
    EXPECT_NEAR(position->length(), 0.5, 1e-4);
}

} // namespace
} // namespace sparselens
