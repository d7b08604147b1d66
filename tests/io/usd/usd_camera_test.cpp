#include "base/error.h"
#include "io/usd/usd_camera.h"
#include "io/usd/usd_transform.h"
#include "lens/thin_lens.h"
#include "support/scratch_folder.h"
#include "view/lens_views.h"
#include "view/resolve_lens.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace sparselens {
namespace {

const Windows wide = windows_of_size(1920, 1080);

class UsdCamerasInFiles : public testing::Test {
protected:
    ScratchFolder folder;

    std::string put(const std::string &text) {
        put_contents(folder.file("shot.usda"), "#usda 1.0\n" + text);
        return folder.file("shot.usda");
    }
    FilmCamera film(const std::string &text, double time = 0) {
        const UsdCameras usd(put(text));
        return film_camera(usd, usd.cameras[0], time);
    }
    FilmCamera camera(const std::string &attributes, double time = 0) {
        return film("def Camera \"c\" {\n" + attributes + "\n}", time);
    }
    std::string error_of(const std::string &attributes) {
        return what_of<Error>([&] { camera(attributes); });
    }
    // Where a point of the camera's space stands in the world. Cameras look along -z in USD, along +z here.
    Imath::V3d in_world(const FilmCamera &of, const Imath::V3d &p) {
        return p * of.world_to_camera.inverse();
    }
    void expect_near(const Imath::V3d &found, const Imath::V3d &expected) {
        EXPECT_NEAR((found - expected).length(), 0, 1e-12) << found << " and not " << expected;
    }
};

// The same lens of 35 mm at f/2 before a film of 36 mm, focused at 3 m, at three scales of the scene.
TEST_F(UsdCamerasInFiles, AperturesAreInTenthsOfASceneUnit) {
    struct Scale {
        double metres_per_unit, focal, film, focus;
    };
    for (const Scale &s : {Scale{0.001, 350, 360, 3000}, Scale{0.01, 35, 36, 300}, Scale{1, 0.35, 0.36, 3}}) {
        const FilmCamera found =
            film(fmt::format("( metersPerUnit = {} )\ndef Camera \"c\" {{ float focalLength = {}\nfloat "
                             "horizontalAperture = {}\nfloat verticalAperture = {}\nfloat fStop = 2\nfloat "
                             "focusDistance = {}\nfloat horizontalApertureOffset = {} }}",
                             s.metres_per_unit, s.focal, s.film, s.film * 9 / 16, s.focus, s.film / 4));
        const Camera on_picture = with_film(found, {}, wide);
        EXPECT_DOUBLE_EQ(*on_picture.focal_length_mm, 35);
        EXPECT_DOUBLE_EQ(*on_picture.sensor_width_mm, 36);
        EXPECT_EQ(on_picture.focus_distance, s.focus);
        // 35 mm / (2 x 2) = 8.75 mm
        const ThinLens lens = resolve_lens(on_picture, wide);
        EXPECT_NEAR(lens.radius * s.metres_per_unit, 0.00875, 1e-15);
        EXPECT_NEAR(lens.radius, s.focal / 10 / (2 * 2), 1e-12);
        EXPECT_NEAR(lens.focal_px, 1920 * 35.0 / 36, 1e-9);
        // The frustum's window moves right by a quarter of its width, so the axis is left of the middle.
        EXPECT_NEAR(on_picture.principal_point->x, -0.25, 1e-15);
    }
    EXPECT_DOUBLE_EQ(camera("float horizontalAperture = 36").film_width_mm,
                     36); // USD's default unit: a centimetre
}

TEST_F(UsdCamerasInFiles, WithoutValuesHaveThoseOfUsd) {
    const FilmCamera found = camera("");
    EXPECT_DOUBLE_EQ(found.focal_length_mm, 50);
    EXPECT_DOUBLE_EQ(found.film_width_mm, 20.955);
    EXPECT_DOUBLE_EQ(found.film_height_mm, 15.2908);
    EXPECT_FALSE(found.fstop);
    EXPECT_FALSE(found.focus_distance);
}

// fStop 0 switches depth of field off; the lens is then known only by our own attributes.
TEST_F(UsdCamerasInFiles, WithoutDepthOfFieldKeepTheirLensInOurAttributes) {
    EXPECT_FALSE(camera("float fStop = 0\nfloat focusDistance = 0").fstop);
    const FilmCamera found =
        camera("float fStop = 0\nfloat focusDistance = 5\ncustom double sparselens:fStop = 2.8\n"
               "custom double sparselens:focusDistance = inf");
    EXPECT_EQ(found.fstop, 2.8);
    EXPECT_TRUE(std::isinf(*found.focus_distance));
}

TEST_F(UsdCamerasInFiles, LookAlongMinusZ) {
    const FilmCamera found = camera("double3 xformOp:translate = (1, 2, 3)\nuniform token[] xformOpOrder = "
                                    "[\"xformOp:translate\"]");
    expect_near(in_world(found, {0, 0, 0}), {1, 2, 3});
    expect_near(in_world(found, {0, 0, 1}), {1, 2, 2}); // forward
    expect_near(in_world(found, {1, 0, 0}), {2, 2, 3}); // right
    expect_near(in_world(found, {0, 1, 0}), {1, 3, 3}); // up
}

TEST_F(UsdCamerasInFiles, StandWhereTheirOperationsPutThem) {
    struct Case {
        const char *operations, *order;
        Imath::V3d place, forward, up;
    };
    const Imath::V3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), back(0, 0, -1), origin(0, 0, 0);
    for (const Case &c : {
             Case{"double xformOp:rotateX = 90", "\"xformOp:rotateX\"", origin, y,
                  z}, // a camera of Blender, upright
             Case{"double xformOp:rotateY = 90", "\"xformOp:rotateY\"", origin, -x, y},
             Case{"double xformOp:rotateZ = 90", "\"xformOp:rotateZ\"", origin, back, -x},
             // X first, then Z: tilted up to look along y, then turned left.
             Case{"double3 xformOp:rotateXYZ = (90, 0, 90)", "\"xformOp:rotateXYZ\"", origin, -x, z},
             // Z first, then X: its up is turned left, then it looks along y.
             Case{"double3 xformOp:rotateZYX = (90, 0, 90)", "\"xformOp:rotateZYX\"", origin, y, -x},
             Case{"quatd xformOp:orient = (0.5, 0.5, 0, 0)", "\"xformOp:orient\"", origin, y,
                  z}, // 90 degrees about x
             // The last operation comes first.
             Case{"double3 xformOp:translate = (5, 0, 0)\ndouble xformOp:rotateZ = 90\ndouble "
                  "xformOp:translateY:b = 1",
                  "\"xformOp:translate\", \"xformOp:rotateZ\", \"xformOp:translateY:b\"",
                  {4, 0, 0},
                  back,
                  -x},
             Case{"double3 xformOp:translate:p = (1, 2, 3)\ndouble3 xformOp:scale = (2, 2, 2)",
                  "\"xformOp:translate:p\", \"xformOp:scale\", \"!invert!xformOp:translate:p\"",
                  {-1, -2, -3},
                  back,
                  y},
             Case{"matrix4d xformOp:transform = ((0, 0, 1, 0), (0, 1, 0, 0), (-1, 0, 0, 0), (7, 8, 9, 1))",
                  "\"xformOp:transform\"",
                  {7, 8, 9},
                  x,
                  y},
             Case{"double3 xformOp:translate = (1, 2, 3)", "", origin, back, y}, // not in the order
         }) {
        SCOPED_TRACE(c.operations);
        const FilmCamera found =
            camera(fmt::format("{}\nuniform token[] xformOpOrder = [{}]", c.operations, c.order));
        expect_near(in_world(found, {0, 0, 0}), c.place);
        expect_near(in_world(found, {0, 0, 1}) - c.place, c.forward);
        expect_near(in_world(found, {0, 1, 0}) - c.place, c.up);
    }
}

TEST_F(UsdCamerasInFiles, FollowTheirParentsWithoutTheirScale) {
    const auto nested = [](const char *reset) {
        return fmt::format(
            "def Xform \"w\" {{ double3 xformOp:translate = (10, 0, 0)\nfloat3 xformOp:scale = (2, 2, "
            "2)\nuniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:scale\"]\ndef Scope "
            "\"s\" {{ def Camera \"c\" {{ double3 xformOp:translate = (1, 2, 3)\nuniform token[] "
            "xformOpOrder = [{}\"xformOp:translate\"] }} }} }}",
            reset);
    };
    expect_near(in_world(film(nested("")), {0, 0, 0}), {12, 4, 6});
    expect_near(in_world(film(nested("")), {0, 0, 1}), {12, 4, 5}); // a unit is a unit of the world
    expect_near(in_world(film(nested("\"!resetXformStack!\", ")), {0, 0, 0}), {1, 2, 3});
}

TEST_F(UsdCamerasInFiles, KeysAreLinearAndConstantOutside) {
    const std::string keyed =
        "double3 xformOp:translate.timeSamples = { 1: (0, 0, 0), 5: (8, 4, 0) }\nuniform token[] "
        "xformOpOrder = [\"xformOp:translate\"]\nfloat fStop = 9\nfloat fStop.timeSamples = { 1: "
        "2, 5: 4 }\nfloat focalLength = 35";
    const std::pair<double, double> shares[] = {{-3, 0}, {1, 0}, {2, 0.25}, {4.5, 0.875}, {5, 1}, {9, 1}};
    for (const auto &[time, share] : shares) {
        expect_near(in_world(camera(keyed, time), {0, 0, 0}), {8 * share, 4 * share, 0});
        EXPECT_DOUBLE_EQ(*camera(keyed, time).fstop, 2 + 2 * share);
        EXPECT_DOUBLE_EQ(camera(keyed, time).focal_length_mm, 35);
    }
    // Rotations in quaternions turn evenly: a third of 90 degrees.
    const FilmCamera turned =
        camera(fmt::format("quatd xformOp:orient.timeSamples = {{ 0: (1, 0, 0, 0), 3: ({}, 0, {}, "
                           "0) }}\nuniform token[] xformOpOrder = [\"xformOp:orient\"]",
                           std::sqrt(0.5), std::sqrt(0.5)),
               1);
    expect_near(in_world(turned, {0, 0, 1}), {-0.5, 0, -std::sqrt(0.75)});
}

TEST_F(UsdCamerasInFiles, FitThePictureAsTheRenderSettingsSay) {
    // A film of 4:3 before a picture of 16:9.
    const auto width = [&](const char *policy, const Windows &windows) {
        const FilmCamera found = film(
            fmt::format("def Camera \"c\" {{ float horizontalAperture = 36\nfloat verticalAperture = 27 }}\n"
                        "def RenderSettings \"s\" {{ uniform token aspectRatioConformPolicy = \"{}\" }}",
                        policy));
        return *with_film(found, {}, windows).sensor_width_mm;
    };
    const Windows tall = windows_of_size(1000, 1000);
    EXPECT_DOUBLE_EQ(width("expandAperture", wide), 48); // 27 mm high
    EXPECT_DOUBLE_EQ(width("expandAperture", tall), 36);
    EXPECT_DOUBLE_EQ(width("cropAperture", wide), 36);
    EXPECT_DOUBLE_EQ(width("cropAperture", tall), 27);
    EXPECT_DOUBLE_EQ(width("adjustApertureWidth", wide), 48);
    EXPECT_DOUBLE_EQ(width("adjustApertureWidth", tall), 27);
    EXPECT_DOUBLE_EQ(width("adjustApertureHeight", tall), 36);
    EXPECT_DOUBLE_EQ(width("adjustPixelAspectRatio", wide), 36);
    Windows anamorphic = windows_of_size(1000, 1000);
    anamorphic.pixel_aspect = 2;
    EXPECT_DOUBLE_EQ(width("expandAperture", anamorphic), 54);
}

// worldToNDC of the standard: a point on the right border at the film's height has x = 1.
TEST_F(UsdCamerasInFiles, ProjectTheirFrustumToThePicture) {
    const FilmCamera found =
        camera("float focalLength = 18\nfloat horizontalAperture = 36\nfloat verticalAperture = "
               "20.25\nfloat horizontalApertureOffset = 9\nfloat verticalApertureOffset = -4.5\n"
               "double3 xformOp:translate = (3, 4, 5)\nuniform token[] xformOpOrder = "
               "[\"xformOp:translate\"]");
    const Camera on_picture = with_film(found, {}, wide);
    const Imath::V3d camera_at(3, 4, 5);
    const auto seen = [&](double x, double y) { // on the film, mm from its middle, at depth 18
        Imath::V3d point;
        on_picture.world_to_ndc->multVecMatrix(camera_at + Imath::V3d(x + 9, y - 4.5, -18), point);
        return Imath::V2d(point.x, point.y);
    };
    EXPECT_NEAR((seen(-18, 10.125) - Imath::V2d(0, 0)).length(), 0, 1e-12);
    EXPECT_NEAR((seen(18, -10.125) - Imath::V2d(1, 1)).length(), 0, 1e-12);
    EXPECT_NEAR((seen(0, 0) - Imath::V2d(0.5, 0.5)).length(), 0, 1e-12);
    const auto frustum = frustum_of(*on_picture.world_to_ndc, *on_picture.world_to_camera);
    ASSERT_TRUE(frustum);
    EXPECT_NEAR(frustum->field, 2, 1e-12);
    EXPECT_NEAR((frustum->principal_point - *on_picture.principal_point).length(), 0, 1e-12);
}

TEST_F(UsdCamerasInFiles, ThatCannotBeUsedAreRefused) {
    const auto refuses = [&](const std::string &attributes, const std::string &why) {
        EXPECT_NE(error_of(attributes).find("shot.usda: /c: "), std::string::npos) << error_of(attributes);
        EXPECT_NE(error_of(attributes).find(why), std::string::npos) << error_of(attributes);
    };
    const auto ordered = [](const std::string &attributes, const std::string &order) {
        return attributes + "\nuniform token[] xformOpOrder = [\"" + order + "\"]";
    };
    refuses("token projection = \"orthographic\"", "orthographic");
    refuses("float focalLength = 0", "focalLength is 0");
    refuses("float horizontalAperture = -1", "horizontalAperture is -1");
    refuses("float verticalAperture = inf", "verticalAperture is inf");
    refuses("float fStop = -2", "fStop is -2");
    refuses("float focalLength = (1, 2)", "focalLength must be 1 number");
    refuses("float focalLength = None", "focalLength must be 1 number");
    refuses("float focalLength.connect = </a.b>", "comes from a connection");
    refuses("float fStop.spline = { 1: 5; 2: 6 }", "comes from a spline");
    refuses(ordered("double3 xformOp:scale = (1, -1, 1)", "xformOp:scale"), "mirrored");
    refuses(ordered("double3 xformOp:scale = (1, 0, 1)", "xformOp:scale"), "singular");
    refuses(ordered("double3 xformOp:scale = (0, 1, 1)", "!invert!xformOp:scale"), "has no inverse");
    refuses(ordered("matrix4d xformOp:transform = ((1,0,0,0),(0.5,1,0,0),(0,0,1,0),(0,0,0,1))",
                    "xformOp:transform"),
            "sheared");
    refuses(ordered("double xformOp:spin = 1", "xformOp:spin"), "xformOp:spin is not understood");
    refuses(ordered("", "xformOp:translate"), "xformOp:translate, which is missing");
    refuses(ordered("double xformOp:rotateXYX = 1", "xformOp:rotateXYX"), "not understood");
}

TEST_F(UsdCamerasInFiles, AreFoundByNameAndByFile) {
    const UsdCameras usd(
        put("def Xform \"a\" { def Camera \"left\" { } def Camera \"shot\" { } } def Xform \"b\" { def "
            "Camera \"left\" { } }"));
    EXPECT_EQ(text_of(camera_called(usd, "shot")), "/a/shot");
    EXPECT_EQ(text_of(camera_called(usd, "/b/left")), "/b/left");
    const auto error = [&](const char *name) {
        return what_of<UsageError>([&] { camera_called(usd, name); });
    };
    EXPECT_NE(error("").find("several cameras: give `camera_name`, one of /a/left, /a/shot, /b/left"),
              std::string::npos);
    EXPECT_NE(error("left").find("several of that name"), std::string::npos);
    EXPECT_NE(error("nobody").find("no camera 'nobody'"), std::string::npos);
    ASSERT_TRUE(camera_of_file(usd, "views/shot.0001.exr"));
    EXPECT_EQ(text_of(*camera_of_file(usd, "views/shot.0001.exr")), "/a/shot");
    EXPECT_EQ(camera_of_file(usd, "shots.exr"), nullptr);
}

// A writer that took lengths for millimetres in a scene of metres.
TEST_F(UsdCamerasInFiles, OfImplausibleLengthAreWarnedOf) {
    const auto warning = [&](double unit) {
        return film_warning(
            film(fmt::format("( metersPerUnit = {} )\ndef Camera \"c\" {{ float focalLength = 50 }}", unit)));
    };
    EXPECT_FALSE(warning(0.01));
    ASSERT_TRUE(warning(1));
    EXPECT_NE(warning(1)->find("its focal length is 5000 mm"), std::string::npos) << *warning(1);
    EXPECT_NE(warning(1)->find("if 50 means millimetres, give `focal_length`"), std::string::npos)
        << *warning(1);
}

} // namespace
} // namespace sparselens
