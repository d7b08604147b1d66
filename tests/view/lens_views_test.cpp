#include "base/error.h"
#include "view/lens_views.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

// A camera turned and far from the world's origin, then moved across its own lens.
Camera camera_at(double x, double y, double z = 0) {
    Imath::M44d to_world, move;
    to_world.rotate(Imath::V3d(0.3, -0.7, 0.2));
    to_world[3][0] = 100;
    to_world[3][1] = -40;
    to_world[3][2] = 7;
    move.setTranslation(Imath::V3d(-x, -y, -z));
    Camera camera;
    camera.world_to_camera = to_world.inverse() * move;
    return camera;
}

const std::vector<std::string> names{"a.exr", "b.exr", "c.exr", "d.exr"};

void expect_positions(const LensViews &views, const std::vector<Imath::V2d> &expected) {
    ASSERT_EQ(views.positions.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_LT((views.positions[i] - expected[i]).length(), 1e-9) << i;
}

void expect_at(const Camera &camera, double x, double y) {
    const auto position = position_relative_to(camera_at(0, 0), camera, "centre");
    ASSERT_TRUE(position);
    EXPECT_LT((*position - Imath::V3d(x, y, 0)).length(), 1e-9);
}

TEST(LensViews, RelativeToTheCameraAtTheCentre) {
    const std::vector<Camera> views{camera_at(0.1, 0.2), camera_at(-0.3, 0)};
    const LensViews placed = place_on_lens(views, names, camera_at(0, 0));
    expect_positions(placed, {{0.1, 0.2}, {-0.3, 0}});
    EXPECT_FALSE(placed.centre_guessed);
    expect_at(placed.centre, 0, 0);
}

TEST(LensViews, ViewsThatKnowTheirLensPointKnowTheCentre) {
    std::vector<Camera> views{camera_at(0.1, 0.2), camera_at(-0.3, 0)};
    views[0].lens_points = {{0.1, 0.2}};
    views[1].lens_points = {{-0.3, 0}};
    const LensViews placed = place_on_lens(views, names, {});
    expect_positions(placed, {{0.1, 0.2}, {-0.3, 0}});
    EXPECT_FALSE(placed.centre_guessed);
    expect_at(placed.centre, 0, 0);
}

TEST(LensViews, ElseTheMeanOfThePositions) {
    const std::vector<Camera> views{camera_at(1, 0), camera_at(2, 0), camera_at(2, 1), camera_at(1, 1)};
    const LensViews placed = place_on_lens(views, names, {});
    expect_positions(placed, {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}});
    EXPECT_TRUE(placed.centre_guessed);
    expect_at(placed.centre, 1.5, 0.5);
}

TEST(LensViews, WorldToNdcFollowsTheCamera) {
    Imath::M44d projection; // some camera space to NDC
    projection[0][0] = 1.5;
    projection[1][1] = -2;
    projection[2][3] = 1;
    projection[3][3] = 0;
    Camera camera = camera_at(0, 0), there = camera_at(0.25, -0.5);
    camera.world_to_ndc = *camera.world_to_camera * projection;
    const Camera moved = moved_across_lens(camera, {0.25, -0.5});
    EXPECT_TRUE(moved.world_to_camera->equalWithAbsError(*there.world_to_camera, 1e-9));
    EXPECT_TRUE(moved.world_to_ndc->equalWithAbsError(*there.world_to_camera * projection, 1e-9));
}

TEST(LensViews, RefusesWhatIsNoLens) {
    const std::vector<Camera> behind{camera_at(0.1, 0), camera_at(-0.1, 0, 0.05)};
    EXPECT_THROW(place_on_lens(behind, names, camera_at(0, 0)), Error);
    Camera turned = camera_at(0, 0);
    Imath::M44d turn;
    turn.rotate(Imath::V3d(0, 0.1, 0));
    turned.world_to_camera = *turned.world_to_camera * turn;
    EXPECT_THROW(place_on_lens(std::vector{camera_at(0, 0), turned}, names, {}), Error);
    EXPECT_THROW(place_on_lens(std::vector{camera_at(0, 0), Camera()}, names, {}), UsageError);
}

TEST(LensViews, RoundingFarFromTheOriginIsNoDepth) {
    std::vector<Camera> views{camera_at(0.01, 0), camera_at(-0.01, 0)};
    for (Camera &view : views) view.world_to_camera = Imath::M44d(Imath::M44f(*view.world_to_camera));
    EXPECT_NO_THROW(place_on_lens(views, names, {}));
}

} // namespace
} // namespace sparselens
