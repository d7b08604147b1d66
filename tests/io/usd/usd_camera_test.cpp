#include "base/error.h"
#include "io/usd/usd_camera.h"
#include "lens/thin_lens.h"
#include "support/scratch_folder.h"
#include "view/lens_views.h"
#include "view/resolve_lens.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace sparselens {
namespace {

using Json = nlohmann::json;
const Windows wide = windows_of_size(1920, 1080);

// Cameras as share/python/usd_cameras.py reads them; tests/tools/usd_cameras_test.py tests the script.
class UsdCamerasInFiles : public testing::Test {
protected:
    ScratchFolder folder;

    // A frame with these values; others are USD's.
    static Json frame(const std::string &values = "{}") {
        Json json{{"time", 0},
                  {"to_world", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
                  {"focalLength", 50},
                  {"horizontalAperture", 20.955},
                  {"verticalAperture", 15.2908},
                  {"fStop", 0},
                  {"focusDistance", 0}};
        json.update(Json::parse(values));
        return json;
    }
    static Json stage(const Json &cameras) {
        return {{"metersPerUnit", 0.01},
                {"upAxis", "Y"},
                {"timeCodesPerSecond", 24},
                {"settings", nullptr},
                {"cameras", cameras}};
    }
    static Json stage_of_one(const std::vector<Json> &frames) {
        Json camera{{"path", "/c"}, {"projection", "perspective"}};
        camera["frames"] = frames;
        return stage(Json::array({camera}));
    }
    UsdCameras read(const std::string &text) {
        put_contents(folder.file("shot.json"), text);
        return read_usd_cameras(folder.file("shot.json"), {});
    }
    FilmCamera film(const Json &json, double time = 0) {
        const UsdCameras usd = read(json.dump());
        return film_camera(usd, usd.cameras[0], time);
    }
    FilmCamera camera(const std::string &values) { return film(stage_of_one({frame(values)})); }
    std::string error_of(const Json &json) {
        return what_of<Error>([&] { film(json); });
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
        Json json = stage_of_one({frame(fmt::format(
            R"({{"focalLength": {}, "horizontalAperture": {}, "verticalAperture": {}, "fStop": 2,
                 "focusDistance": {}, "horizontalApertureOffset": {}}})",
            s.focal, s.film, s.film * 9 / 16, s.focus, s.film / 4))});
        json["metersPerUnit"] = s.metres_per_unit;
        const Camera on_picture = with_film(film(json), {}, wide);
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
}

// fStop 0 switches depth of field off; the lens is then known only by our own attributes.
TEST_F(UsdCamerasInFiles, WithoutDepthOfFieldKeepTheirLensInOurAttributes) {
    EXPECT_FALSE(camera("{}").fstop);
    EXPECT_FALSE(camera("{}").focus_distance);
    const FilmCamera found =
        camera(R"({"focusDistance": 5, "sparselens:fStop": 2.8, "sparselens:focusDistance": null})");
    EXPECT_EQ(found.fstop, 2.8);
    EXPECT_TRUE(std::isinf(*found.focus_distance));
}

TEST_F(UsdCamerasInFiles, LookAlongMinusZ) {
    const FilmCamera found = camera(R"({"to_world": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]})");
    expect_near(in_world(found, {0, 0, 0}), {1, 2, 3});
    expect_near(in_world(found, {0, 0, 1}), {1, 2, 2}); // forward
    expect_near(in_world(found, {1, 0, 0}), {2, 2, 3}); // right
    expect_near(in_world(found, {0, 1, 0}), {1, 3, 3}); // up
}

TEST_F(UsdCamerasInFiles, HaveNoScale) {
    const FilmCamera found = camera(R"({"to_world": [0, 0, 2, 0, 0, 2, 0, 0, -2, 0, 0, 0, 7, 8, 9, 1]})");
    expect_near(in_world(found, {0, 0, 0}), {7, 8, 9});
    expect_near(in_world(found, {0, 0, 1}), {8, 8, 9}); // a unit is a unit of the world
    expect_near(in_world(found, {0, 1, 0}), {7, 9, 9});
}

TEST_F(UsdCamerasInFiles, AreKnownAtTheirFramesAndConstantOutside) {
    const Json keyed =
        stage_of_one({frame(R"({"time": 1, "fStop": 2})"), frame(R"({"time": 2.5, "fStop": 4})")});
    const std::pair<double, double> fstops[] = {{-3, 2}, {1, 2}, {2.5, 4}, {9, 4}};
    for (const auto &[time, fstop] : fstops) EXPECT_EQ(film(keyed, time).fstop, fstop);
    EXPECT_NE(what_of<Error>([&] {
                  film(keyed, 2);
              }).find("/c: is known at frames 1 and 2.5, but not at 2 between"),
              std::string::npos);
}

TEST_F(UsdCamerasInFiles, FitThePictureAsTheRenderSettingsSay) {
    // A film of 4:3 before a picture of 16:9.
    const auto width = [&](const char *policy, const Windows &windows) {
        Json json = stage_of_one({frame(R"({"horizontalAperture": 36, "verticalAperture": 27})")});
        json["settings"] = {{"path", "/s"},
                            {"resolution", nullptr},
                            {"pixelAspectRatio", 1},
                            {"aspectRatioConformPolicy", policy}};
        return *with_film(film(json), {}, windows).sensor_width_mm;
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
    const FilmCamera found = camera(
        R"({"focalLength": 18, "horizontalAperture": 36, "verticalAperture": 20.25, "horizontalApertureOffset": 9,
            "verticalApertureOffset": -4.5, "to_world": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1]})");
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
    const auto refuses = [&](const Json &json, const std::string &why) {
        EXPECT_NE(error_of(json).find("shot.json: /c: "), std::string::npos) << error_of(json);
        EXPECT_NE(error_of(json).find(why), std::string::npos) << error_of(json);
    };
    const auto values = [](const std::string &text) { return stage_of_one({frame(text)}); };
    Json orthographic = values("{}");
    orthographic["cameras"][0]["projection"] = "orthographic";
    refuses(orthographic, "orthographic");
    refuses(values(R"({"focalLength": 0})"), "focalLength is 0");
    refuses(values(R"({"horizontalAperture": -1})"), "horizontalAperture is -1");
    refuses(values(R"({"verticalAperture": null})"), "verticalAperture is inf");
    refuses(values(R"({"fStop": -2})"), "fStop is -2");
    refuses(values(R"({"focalLength": [1, 2]})"), "focalLength must be 1 number");
    refuses(values(R"({"to_world": [1, 2]})"), "to_world must be 16 numbers");
    Json without = values("{}");
    without["cameras"][0]["frames"][0].erase("focalLength");
    refuses(without, "focalLength is missing");
    without["cameras"][0]["frames"][0].erase("to_world");
    refuses(without, "to_world is missing");
    const auto transformed = [&](const std::string &rows) {
        return values(R"({"to_world": [)" + rows + ", 0, 0, 0, 1]}");
    };
    refuses(transformed("1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0"), "mirrored");
    refuses(transformed("1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0"), "singular");
    refuses(transformed("1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0"), "sheared");
    refuses(values(R"({"to_world": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1e20, 0, 0, 1]})"), "out of range");
    refuses(stage(Json::array({Json{{"path", "/c"}, {"error", "fStop comes from a connection"}}})),
            "fStop comes from a connection");
}

TEST_F(UsdCamerasInFiles, OfBrokenJsonAreRefused) {
    const auto refuses = [&](const std::string &text, const std::string &why) {
        const std::string error = what_of<Error>([&] { read(text); });
        EXPECT_TRUE(error.starts_with(folder.file("shot.json"))) << error;
        EXPECT_NE(error.find(why), std::string::npos) << error;
    };
    const auto with = [](const char *key, const Json &value) {
        Json json = stage_of_one({frame()});
        json[key] = value;
        return json.dump();
    };
    refuses("#usda 1.0", "not JSON");
    refuses("{}", "metersPerUnit");
    refuses("[]", "has no cameras as usd_cameras.py writes them");
    refuses(with("metersPerUnit", 0), "metersPerUnit must be above 0");
    refuses(with("timeCodesPerSecond", -1), "timeCodesPerSecond must be above 0");
    refuses(with("upAxis", "X"), "upAxis must be");
    refuses(with("cameras", Json::array()), "has no camera");
    refuses(stage_of_one({}).dump(), "/c: has no frames");
    refuses(stage_of_one({frame(R"({"fStop": "wide"})")}).dump(), "has no cameras as");
    const auto settings = [&](const Json &size, double aspect) {
        return with("settings", {{"path", "/s"},
                                 {"resolution", size},
                                 {"pixelAspectRatio", aspect},
                                 {"aspectRatioConformPolicy", "expandAperture"}});
    };
    EXPECT_EQ(read(settings({640, 360}, 2)).resolution, Imath::V2i(640, 360));
    EXPECT_EQ(read(settings({640, 360}, 2)).pixel_aspect, 2);
    refuses(settings({640, 0}, 1), "/s: its resolution is not a size");
    refuses(settings({640, 360, 1}, 1), "/s: its resolution is not a size");
    refuses(settings({640, 1.5}, 1), "/s: its resolution is not a size");
    refuses(settings({640, 360}, 0), "/s: its pixelAspectRatio is out of range");
}

TEST_F(UsdCamerasInFiles, AreFoundByNameAndByFile) {
    Json cameras;
    for (const char *path : {"/a/left", "/a/shot", "/b/left"})
        cameras.push_back({{"path", path}, {"frames", Json::array({frame()})}});
    const UsdCameras usd = read(stage(cameras).dump());
    EXPECT_EQ(camera_called(usd, "shot").path, "/a/shot");
    EXPECT_EQ(camera_called(usd, "/b/left").path, "/b/left");
    const auto error = [&](const char *name) {
        return what_of<UsageError>([&] { camera_called(usd, name); });
    };
    EXPECT_NE(error("").find("several cameras: give `camera_name`, one of /a/left, /a/shot, /b/left"),
              std::string::npos);
    EXPECT_NE(error("left").find("several of that name"), std::string::npos);
    EXPECT_NE(error("nobody").find("no camera 'nobody'"), std::string::npos);
    ASSERT_TRUE(camera_of_file(usd, "views/shot.0001.exr"));
    EXPECT_EQ(camera_of_file(usd, "views/shot.0001.exr")->path, "/a/shot");
    EXPECT_EQ(camera_of_file(usd, "shots.exr"), nullptr);
}

// A writer that took lengths for millimetres in a scene of metres.
TEST_F(UsdCamerasInFiles, OfImplausibleLengthAreWarnedOf) {
    const auto warnings = [&](double unit, bool given) {
        Json json = stage_of_one({frame()});
        json["metersPerUnit"] = unit;
        return film_warnings(film(json), given);
    };
    EXPECT_TRUE(warnings(0.01, false).empty());
    EXPECT_TRUE(warnings(1, true).empty());
    ASSERT_EQ(warnings(1, false).size(), 1u);
    const std::string warning = warnings(1, false)[0];
    EXPECT_NE(warning.find("its focal length is 5000 mm"), std::string::npos) << warning;
    EXPECT_NE(warning.find("if 50 means millimetres, give `focal_length`"), std::string::npos) << warning;
}

TEST_F(UsdCamerasInFiles, OfAStageThatLacksFilesAreWarnedOf) {
    Json json = stage_of_one({frame()});
    json["warnings"] = {"cannot open set.usd", "cannot open props.usd"};
    const std::vector<std::string> warnings = film_warnings(film(json), false);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(warnings[0].ends_with("shot.json: cannot open set.usd (and 1 more)")) << warnings[0];
}

} // namespace
} // namespace sparselens
