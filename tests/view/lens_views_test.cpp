#include "base/error.h"
#include "support/scratch_folder.h"
#include "view/lens_views.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

// A camera that is rotated and far from the world's origin, then moved in the plane of its lens.
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

// Files without the attribute have one pixel per pixel of the picture.
TEST(PlaceViews, ViewsHaveTheSubpixelsOfTheCentre) {
    const auto placed = [](std::optional<int> centre, std::optional<int> view) {
        std::vector<StatedView> stated{{"center.exr", {}, {}}, {"view.exr", {}, Imath::V2d(1, 0)}};
        stated[0].camera.supersample = centre;
        stated[1].camera.supersample = view;
        return what_of<Error>([&] { place_cameras(stated); });
    };
    EXPECT_EQ(placed({}, 1), "(nothing was thrown)");
    EXPECT_EQ(placed(2, 2), "(nothing was thrown)");
    EXPECT_EQ(placed(2, {}), "view.exr: 1 x 1 of its pixels are one of the picture, and 2 x 2 of center.exr "
                             "(ldi.supersample): use files that agree, or say it for all by `supersample`");
    EXPECT_EQ(placed({}, 4).substr(0, 19), "view.exr: 4 x 4 of ");
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
    const LensViews placed = position_on_lens(views, names, camera_at(0, 0));
    expect_positions(placed, {{0.1, 0.2}, {-0.3, 0}});
    EXPECT_FALSE(placed.centre_guessed);
    expect_at(placed.centre, 0, 0);
}

TEST(LensViews, ViewsThatKnowTheirLensPointKnowTheCentre) {
    std::vector<Camera> views{camera_at(0.1, 0.2), camera_at(-0.3, 0)};
    views[0].lens_points = {{0.1, 0.2}};
    views[1].lens_points = {{-0.3, 0}};
    const LensViews placed = position_on_lens(views, names, {});
    expect_positions(placed, {{0.1, 0.2}, {-0.3, 0}});
    EXPECT_FALSE(placed.centre_guessed);
    expect_at(placed.centre, 0, 0);
}

TEST(LensViews, ElseTheMeanOfThePositions) {
    const std::vector<Camera> views{camera_at(1, 0), camera_at(2, 0), camera_at(2, 1), camera_at(1, 1)};
    const LensViews placed = position_on_lens(views, names, {});
    expect_positions(placed, {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}});
    EXPECT_TRUE(placed.centre_guessed);
    expect_at(placed.centre, 1.5, 0.5);
}

TEST(LensViews, WorldToNdcFollowsTheCamera) {
    Imath::M44d projection; // camera space to NDC
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
    const std::vector<Camera> far_behind{camera_at(0.1, 0), camera_at(-0.1, 0, 0.11)};
    EXPECT_THROW(position_on_lens(far_behind, names, camera_at(0, 0)), Error);
    Camera turned = camera_at(0, 0);
    Imath::M44d turn;
    turn.rotate(Imath::V3d(0, 0.1, 0));
    turned.world_to_camera = *turned.world_to_camera * turn;
    EXPECT_THROW(position_on_lens(std::vector{camera_at(0, 0), turned}, names, {}), Error);
    EXPECT_THROW(position_on_lens(std::vector{camera_at(0, 0), Camera()}, names, {}), UsageError);
}

// `camera` with a projection whose axis is off the middle by this share of the picture's width, right and down.
Camera framed(Camera camera, const Imath::V2d &off, double field = 0.5) {
    const double across = 1 / field, down = across * 16 / 9;
    const Imath::M44d projection(across, 0, 0, 0, 0, -down, 0, 0, 0.5 + off.x, 0.5 + off.y * 16 / 9, 1, 1, 0,
                                 0, -1, 0);
    camera.world_to_ndc = Imath::M44d(Imath::M44f(*camera.world_to_camera * projection));
    camera.world_to_camera = Imath::M44d(Imath::M44f(*camera.world_to_camera));
    camera.principal_point = off;
    return camera;
}

TEST(LensViews, FramingsAreThoseOfTheirFrusta) {
    const std::vector<Camera> views{
        framed(camera_at(0.1, 0), {-0.02, 0}), framed(camera_at(-0.1, 0), {0.02, 0.01}),
        framed(camera_at(0, 0.1, 0.05), {0, 0}, 0.51), framed(camera_at(0, -0.1), {0, 0})};
    const LensViews placed = position_on_lens(views, names, framed(camera_at(0, 0), {0, 0}));
    ASSERT_EQ(placed.framings.size(), 4u);
    EXPECT_EQ(placed.framings[0], (Framing{.principal_point = {-0.02, 0}}));
    EXPECT_EQ(placed.framings[1], (Framing{.principal_point = {0.02, 0.01}}));
    EXPECT_NEAR(placed.framings[2].forward, 0.05, 1e-4);
    EXPECT_NEAR(placed.framings[2].zoom, 0.5 / 0.51, 1e-6);
    EXPECT_EQ(placed.framings[3], Framing()); // float rounding of the matrices is not a framing
}

TEST(LensViews, WhatAViewDoesNotSayIsAsInTheCentre) {
    Camera centre = framed(camera_at(0, 0), {0.1, -0.2});
    const Camera silent = camera_at(0.1, 0);
    EXPECT_EQ(framing_relative_to(centre, silent, "v"), (Framing{.principal_point = {0.1, -0.2}}));
    EXPECT_EQ(framing_relative_to(silent, centre, "v").zoom, 1);
    centre.world_to_ndc.reset();
    Camera view = silent;
    centre.field = 0.5;
    view.field = 0.4;
    EXPECT_DOUBLE_EQ(framing_relative_to(centre, view, "v").zoom, 1.25);
}

// Options have changed the field of the matrix, so the options decide.
TEST(LensViews, OptionsGoBeforeMatrices) {
    Camera centre = framed(camera_at(0, 0), {0, 0}), view = framed(camera_at(0.1, 0), {0, 0}, 0.6);
    EXPECT_NEAR(framing_relative_to(centre, view, "v").zoom, 0.5 / 0.6, 1e-6);
    centre.field = view.field = 0.8;
    EXPECT_EQ(framing_relative_to(centre, view, "v").zoom, 1);
}

TEST(LensViews, AnotherLensIsAnErrorThatNamesTheView) {
    const Camera centre = framed(camera_at(0, 0), {0, 0});
    for (const double field : {0.2, 1.1}) {
        const Camera view = framed(camera_at(0.1, 0), {0, 0}, field);
        const std::string what = what_of<Error>([&] { framing_relative_to(centre, view, "tele.exr"); });
        EXPECT_NE(what.find("tele.exr: its focal length is too far"), std::string::npos) << what;
    }
}

TEST(LensViews, TheMiddleOfConvergingFrustaIsTheirMean) {
    const std::vector<Camera> views{
        framed(camera_at(0.1, 0), {-0.02, 0}), framed(camera_at(-0.1, 0), {0.02, 0}),
        framed(camera_at(0, 0.1), {0, 0.02}), framed(camera_at(0, -0.1), {0, -0.02})};
    const LensViews placed = position_on_lens(views, names, {});
    ASSERT_TRUE(placed.centre.principal_point && placed.centre.world_to_ndc);
    EXPECT_LT(placed.centre.principal_point->length(), 1e-6);
    const auto frustum = frustum_of(*placed.centre.world_to_ndc, *placed.centre.world_to_camera);
    ASSERT_TRUE(frustum);
    EXPECT_LT(frustum->principal_point.length(), 1e-6);
}

TEST(LensViews, PicturesAreMovedWholeInOnePlaneOnly) {
    const Camera centre = framed(camera_at(0, 0), {0, 0});
    const auto why = [&](const Camera &odd) {
        const std::vector<Camera> views{framed(camera_at(0.1, 0), {-0.02, 0}), odd};
        return what_of<Error>([&] { require_one_plane(position_on_lens(views, names, centre), names); });
    };
    EXPECT_EQ(why(framed(camera_at(-0.1, 0), {0.02, 0})), "(nothing was thrown)");
    EXPECT_EQ(why(framed(camera_at(-0.1, 0, 0.01), {0, 0})),
              "b.exr: stands in front of or behind the other views, but a lens is flat: leave it out");
    EXPECT_EQ(why(framed(camera_at(-0.1, 0), {0, 0}, 0.51)),
              "b.exr: its focal length differs from that of the other views");
}

TEST(LensViews, RoundingFarFromTheOriginIsNoDepth) {
    std::vector<Camera> views{camera_at(0.01, 0), camera_at(-0.01, 0)};
    for (Camera &view : views) view.world_to_camera = Imath::M44d(Imath::M44f(*view.world_to_camera));
    EXPECT_NO_THROW(position_on_lens(views, names, {}));
}

} // namespace
} // namespace sparselens
