// Different lenses in the headers of two pictures: each difference is named with both values; equal and unknown values
// are not mentioned.
#include "finish/lens_check.h"

#include <gtest/gtest.h>

#include <limits>

namespace sparselens {
namespace {

using Texts = std::vector<std::string>;

Camera camera() {
    Camera camera;
    camera.focal_length_mm = 50;
    camera.fstop = 2;
    camera.focus_distance = 4;
    camera.looks.blades = 0;
    return camera;
}

TEST(LensHeaders, NothingIsSaidOfTheSameLens) {
    EXPECT_EQ(lens_differences(camera(), camera()), Texts());
    Camera rounded = camera();
    rounded.fstop = 2.01;
    EXPECT_EQ(lens_differences(camera(), rounded), Texts());
    Camera in_centimetres = camera();
    in_centimetres.focus_distance = 400;
    in_centimetres.metres_per_unit = 0.01;
    EXPECT_EQ(lens_differences(camera(), in_centimetres), Texts());
    EXPECT_EQ(lens_differences(camera(), Camera()), Texts());
    EXPECT_EQ(lens_differences(Camera(), camera()), Texts());
}

TEST(LensHeaders, EachMistakeIsNamed) {
    Camera wide = camera(), near = camera(), hexagon = camera(), squeezed = camera();
    wide.fstop = 2 / 1.06;
    near.focus_distance = 4 * 0.97;
    hexagon.looks.blades = 6;
    squeezed.looks.squeeze = 2;
    EXPECT_EQ(lens_differences(camera(), wide), Texts{"an aperture of 13.25 mm radius, not 12.5"});
    EXPECT_EQ(lens_differences(camera(), near), Texts{"focus at 3.88 m, not 4"});
    EXPECT_EQ(lens_differences(camera(), hexagon), Texts{"6 blades, not no blades"});
    EXPECT_EQ(lens_differences(hexagon, camera()), Texts{"no blades, not 6 blades"});
    EXPECT_EQ(lens_differences(camera(), squeezed), Texts{"a squeeze of 2, not 1"});
}

TEST(LensHeaders, AnotherPlaceOfTheCameraIsNamed) {
    Camera here = camera(), rounded = camera(), moved = camera();
    here.world_to_camera = Imath::M44d().setTranslation(Imath::V3d(100, 2, -300));
    rounded.world_to_camera = Imath::M44d().setTranslation(Imath::V3d(100, 2.001, -300));
    moved.world_to_camera = Imath::M44d().setTranslation(Imath::V3d(100, 2.1, -300));
    EXPECT_EQ(lens_differences(here, rounded), Texts());
    EXPECT_EQ(lens_differences(here, moved),
              Texts{"a camera that stands or looks elsewhere (worldToCamera)"});
    EXPECT_EQ(lens_differences(camera(), moved), Texts());
}

TEST(LensHeaders, AnotherProjectionIsNamed) {
    Camera here = camera(), wide = camera(), shifted = camera();
    here.field = 1, wide.field = 1.25;
    EXPECT_EQ(lens_differences(here, wide), Texts{"a focal length of 0.8 widths of the picture, not 1"});
    wide.field = 1.01;
    EXPECT_EQ(lens_differences(here, wide), Texts());
    here.principal_point = Imath::V2d(0.1, 0), shifted.principal_point = Imath::V2d(0.1, 0.05);
    EXPECT_EQ(lens_differences(here, here), Texts());
    EXPECT_EQ(lens_differences(here, shifted), Texts{"a lens shifted elsewhere"});
}

// A hexagon turned by one side is the same.
TEST(LensHeaders, ARotationIsNamedWhereItShows) {
    Camera hexagon = camera(), turned = camera();
    hexagon.looks.blades = turned.looks.blades = 6;
    turned.looks.rotation = 15;
    EXPECT_EQ(lens_differences(hexagon, turned), Texts{"blades turned by 15 degrees, not 0"});
    turned.looks.rotation = 59;
    EXPECT_EQ(lens_differences(hexagon, turned), Texts());
}

TEST(LensHeaders, APinholeIsAnotherLens) {
    Camera pinhole = camera();
    pinhole.fstop = std::numeric_limits<double>::infinity();
    EXPECT_EQ(lens_differences(camera(), pinhole).size(), 1u);
    EXPECT_EQ(lens_differences(pinhole, pinhole), Texts());
    pinhole.focus_distance = std::numeric_limits<double>::infinity();
    EXPECT_EQ(lens_differences(pinhole, pinhole), Texts());
    EXPECT_EQ(lens_differences(camera(), pinhole).size(), 2u);
}

} // namespace
} // namespace sparselens
