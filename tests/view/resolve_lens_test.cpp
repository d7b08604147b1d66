#include "base/error.h"
#include "support/scratch_folder.h"
#include "view/resolve_lens.h"

#include <gtest/gtest.h>

#include <limits>

namespace sparselens {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

Camera known_camera() {
    Camera camera;
    camera.focal_length_mm = 50;
    camera.sensor_width_mm = 25;
    camera.fstop = 2.5;
    camera.focus_distance = 4;
    return camera;
}

const Windows hundred = windows_of_size(100, 60);

TEST(CameraWithOptions, OptionsWin) {
    LensValues options;
    options.focal_length_mm = 100;
    options.sensor_width_mm = 20;
    options.fstop = 8;
    options.focus_distance = inf;
    options.scene_unit = 0.1;
    const Camera camera = camera_with_options(options, known_camera());
    EXPECT_EQ(camera.focal_length_mm, 100);
    EXPECT_EQ(camera.sensor_width_mm, 20);
    EXPECT_EQ(camera.fstop, 8);
    EXPECT_EQ(camera.focus_distance, inf);
    EXPECT_EQ(camera.metres_per_unit, 0.1);
    EXPECT_EQ(camera_with_options({}, known_camera()).fstop, 2.5);
}

// Four metres are 400 centimetres, whether the file or the option gives the unit.
TEST(CameraWithOptions, AnotherSceneUnitLeavesTheFocusWhereItIs) {
    LensValues options;
    options.scene_unit = 0.01;
    EXPECT_DOUBLE_EQ(camera_with_options(options, known_camera()).focus_distance.value(), 400);
    Camera in_centimetres = known_camera();
    in_centimetres.metres_per_unit = 0.01;
    EXPECT_DOUBLE_EQ(camera_with_options(options, in_centimetres).focus_distance.value(), 4);
    options.focus_distance = 7; // scene units already
    EXPECT_EQ(camera_with_options(options, known_camera()).focus_distance, 7);
}

TEST(LensRadius, ByTheFNumber) {
    EXPECT_DOUBLE_EQ(lens_radius_of(known_camera()).value(), 0.01); // 50 mm / 2.5 is 20 mm across
    Camera camera = known_camera();
    camera.metres_per_unit = 0.01;
    EXPECT_DOUBLE_EQ(lens_radius_of(camera).value(), 1);
    camera.fstop = inf;
    EXPECT_EQ(lens_radius_of(camera), 0);
    EXPECT_FALSE(lens_radius_of({}));
}

// The radius is stored in the metadata as an f-number, and read back.
TEST(LensRadius, ByTheOptionAndBack) {
    LensValues options;
    options.lens_radius = 0.125;
    EXPECT_DOUBLE_EQ(lens_radius_of(camera_with_options(options, known_camera())).value(), 0.125);
    EXPECT_EQ(resolve_radius(camera_with_options(options, {})), 0.125);
    options.lens_radius = 0;
    EXPECT_EQ(camera_with_options(options, known_camera()).fstop, inf);
}

// Without a focal length no f-number can store it.
TEST(LensRadius, IsKeptAsGiven) {
    Camera camera;
    camera.field = 1;
    LensValues values;
    values.lens_radius = 0.1;
    camera = camera_with_options(values, camera);
    EXPECT_EQ(lens_radius_of(camera), 0.1);
    EXPECT_FALSE(camera.fstop);
    values = {.fstop = 4, .focus_distance = {}}; // the last one given applies
    EXPECT_FALSE(camera_with_options(values, camera).lens_radius);
}

TEST(ResolveLens, TakesWhatTheCameraSays) {
    Windows wide = hundred;
    wide.pixel_aspect = 2;
    const ThinLens lens = resolve_lens(known_camera(), wide);
    EXPECT_DOUBLE_EQ(lens.radius, 0.01);
    EXPECT_DOUBLE_EQ(lens.focal_px, 200);
    EXPECT_EQ(lens.focus, 4);
    EXPECT_EQ(lens.pixel_aspect, 2);
}

TEST(ResolveLens, WhatIsMissingNamesItsOption) {
    const auto message = [](auto Camera::*unknown) {
        Camera camera = known_camera();
        (camera.*unknown).reset();
        return what_of<UsageError>([&] { resolve_lens(camera, hundred); });
    };
    EXPECT_EQ(message(&Camera::focal_length_mm), "the focal length is unknown: give `focal_length`");
    EXPECT_EQ(message(&Camera::sensor_width_mm), "the sensor width is unknown: give `sensor_width`");
    EXPECT_EQ(message(&Camera::fstop), "the aperture is unknown: give `fstop` or `lens_radius`");
    EXPECT_EQ(message(&Camera::focus_distance), "the focus distance is unknown: give `focus_distance`");
    EXPECT_EQ(
        what_of<UsageError>([&] { resolve_lens({}, hundred); }),
        "the aperture is unknown: give `fstop` or `lens_radius`; the focal length is unknown: give "
        "`focal_length`; the sensor width is unknown: give `sensor_width`; the focus distance is unknown: "
        "give `focus_distance`");
}

TEST(ResolveLens, ABlurBeyondAllPicturesIsRefused) {
    const auto refused = [](LensValues values) {
        return what_of<UsageError>(
                   [&] { resolve_lens(camera_with_options(values, known_camera()), hundred); })
            .starts_with("the blur would be more than 1e30 pixels wide: check");
    };
    EXPECT_TRUE(refused({.lens_radius = 1e308}));
    EXPECT_TRUE(refused({.lens_radius = 1e308, .focus_distance = inf}));
    EXPECT_TRUE(refused({.focal_length_mm = 1e308}));
    EXPECT_TRUE(refused({.fstop = 1e-308}));
    EXPECT_TRUE(refused({.focus_distance = 1e-308}));
    EXPECT_TRUE(refused({.fstop = 2, .scene_unit = 1e-308}));
    EXPECT_FALSE(refused({.lens_radius = 1e20}));
}

TEST(ResolveLens, APinholeNeedsNothingElse) {
    LensValues radius;
    radius.lens_radius = 0;
    EXPECT_EQ(resolve_lens(camera_with_options(radius, {}), hundred).radius, 0);
    Camera closed;
    closed.fstop = inf;
    EXPECT_EQ(resolve_lens(closed, hundred).radius, 0);
}

} // namespace
} // namespace sparselens
