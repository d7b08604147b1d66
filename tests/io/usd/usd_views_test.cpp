#include "base/error.h"
#include "chain/plan_views.h"
#include "chain/stated_camera.h"
#include "io/usd/usd_camera.h"
#include "io/usd/usd_views.h"
#include "lens/thin_lens.h"
#include "support/scratch_folder.h"
#include "view/lens_views.h"
#include "view/resolve_lens.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace sparselens {
namespace {

using Json = nlohmann::json;
const Windows wide = windows_of_size(640, 360);
const Notify nobody = [](const Notice &) {};

// A camera turned by rotations about all axes.
Camera some_camera(double metres_per_unit) {
    Camera camera;
    camera.focal_length_mm = 35;
    camera.sensor_width_mm = 24.5;
    camera.fstop = 2.8;
    camera.focus_distance = 6.5 / metres_per_unit;
    camera.metres_per_unit = metres_per_unit;
    camera.principal_point = Imath::V2d(0.1, -0.05);
    camera.world_to_camera = Imath::M44d().rotate(Imath::V3d(0.3, -0.5, 1.1)) *
                             Imath::M44d().setScale(Imath::V3d(1, 1, -1)) *
                             Imath::M44d().setTranslation(Imath::V3d(3, 4, -5));
    complete_field(camera);
    return camera;
}

class UsdViewsInFiles : public testing::Test {
protected:
    ScratchFolder folder;

    std::string put(const Json &json, const std::string &name = "views.json") {
        put_contents(folder.file(name), json.dump());
        return folder.file(name);
    }
    UsdCameras read(const UsdViews &views) { return read_usd_cameras(put(stage_of(views)), {}); }

    // The cameras of the layer that the script writes, as it reads them again; tests/tools/usd_cameras_test.py asks
    // that it does.
    static Json stage_of(const UsdViews &views) {
        const Json json = Json::parse(usd_views_json(views));
        Json cameras;
        for (const auto &[name, point] : json["points"].items()) {
            Json frames;
            for (const Json &frame : json["frames"]) {
                const double radius = frame["radius"];
                std::vector<double> m = frame["to_world"];
                for (std::size_t k = 0; !point.is_null() && k < 3; ++k)
                    m[12 + k] += radius * (double(point[0]) * m[k] + double(point[1]) * m[4 + k]);
                Json values = frame["camera"];
                values.update({{"time", frame["time"]}, {"to_world", m}, {"fStop", 0}});
                frames.push_back(values);
            }
            cameras.push_back({{"path", "/sparselens/lens/" + name}, {"frames", frames}});
        }
        return {{"metersPerUnit", json["metersPerUnit"]},
                {"upAxis", json["upAxis"]},
                {"timeCodesPerSecond", json["timeCodesPerSecond"]},
                {"settings",
                 {{"path", "/Render/sparselens"},
                  {"resolution", json["resolution"]},
                  {"pixelAspectRatio", json["pixel_aspect"]},
                  {"aspectRatioConformPolicy", "expandAperture"}}},
                {"cameras", cameras}};
    }
    static PlannedViews plan_of(const Camera &camera, const std::vector<Imath::V2d> &points) {
        PlannedViews planned;
        planned.camera = camera;
        planned.setting = {"center.exr", wide, resolve_lens(camera, wide), 2};
        for (const Imath::V2d &point : points) planned.plan.views.push_back({point, {}, 0});
        return planned;
    }
};

// Written and read again at three scales: the frustum, the lens and the positions on the rim are the same.
TEST_F(UsdViewsInFiles, AreReadAgain) {
    for (const double unit : {0.001, 0.01, 1.0}) {
        const Camera camera = some_camera(unit);
        const double radius = radius_of(2.8, 35, unit);
        UsdViews views;
        add_planned(views, plan_of(camera, {{1, 0}, {0, 1}, {-0.6, -0.8}}), {});
        const UsdCameras usd = read(views);
        ASSERT_EQ(usd.cameras.size(), 4u);
        EXPECT_EQ(usd.metres_per_unit, unit);
        EXPECT_EQ(usd.resolution, Imath::V2i(640, 360));
        const Camera centre = with_film(film_camera(usd, camera_called(usd, ""), 0), {}, wide);
        EXPECT_NEAR(*centre.focal_length_mm, 35, 1e-12);
        EXPECT_NEAR(*centre.sensor_width_mm, 24.5, 1e-12);
        EXPECT_EQ(centre.fstop, 2.8);
        EXPECT_EQ(centre.focus_distance, camera.focus_distance);
        EXPECT_NEAR((*centre.principal_point - *camera.principal_point).length(), 0, 1e-12);
        EXPECT_TRUE(centre.world_to_camera->equalWithAbsError(*camera.world_to_camera, 1e-12));
        std::vector<Camera> rim;
        for (const char *name : {"view_0", "view_1", "view_2"})
            rim.push_back(with_film(film_camera(usd, camera_called(usd, name), 0), {}, wide));
        const LensViews placed = position_on_lens(rim, std::vector<std::string>{"0", "1", "2"}, centre);
        const Imath::V2d expected[] = {{radius, 0}, {0, radius}, {-0.6 * radius, -0.8 * radius}};
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR((placed.positions[i] - expected[i]).length(), 0, 1e-12 * radius + 1e-14) << unit;
            EXPECT_EQ(placed.framings[i].zoom, 1);
        }
    }
}

TEST_F(UsdViewsInFiles, SayWhatOfThePictureTheyShow) {
    UsdViews views;
    add_planned(views, plan_of(some_camera(1), {{1, 0}}), {});
    const auto json = [&] { return Json::parse(usd_views_json(views)); };
    EXPECT_EQ(json()["keyed"], false);
    EXPECT_EQ(json()["resolution"], Json::array({640, 360}));
    EXPECT_TRUE(json()["data_window"].is_null());
    views.windows.data = {Imath::V2i(-64, -36), Imath::V2i(639, 359)}; // beyond the left and the top
    EXPECT_EQ(json()["data_window"], Json::array({-0.1, 0.0, 1.0, 1.1}));
    views.frames[0].focus_distance = HUGE_VAL;
    const Json camera = json()["frames"][0]["camera"];
    EXPECT_TRUE(camera["sparselens:focusDistance"].is_null());
    EXPECT_EQ(camera["focusDistance"], 0);
}

// Frames whose plans have different views: the layer has the cameras of all, and only what changes is keyed.
TEST_F(UsdViewsInFiles, HoldAllFramesOfARange) {
    UsdViews views;
    Camera camera = some_camera(1);
    add_planned(views, plan_of(camera, {{1, 0}, {0, 1}}), 7);
    camera.fstop = 1.4;
    add_planned(views, plan_of(camera, {{-1, 0}, {0, 1}}), 8);
    EXPECT_EQ(Json::parse(usd_views_json(views))["keyed"], true);
    const UsdCameras usd = read(views);
    ASSERT_EQ(usd.cameras.size(), 4u);
    for (const int frame : {7, 8}) {
        const double fstop = frame == 7 ? 2.8 : 1.4;
        const double radius = radius_of(fstop, 35, 1);
        const auto at = [&](const char *name) {
            return with_film(film_camera(usd, camera_called(usd, name), frame), {}, wide);
        };
        EXPECT_EQ(at("center").fstop, fstop);
        const auto by = position_relative_to(at("center"), at("view_2"), "");
        ASSERT_TRUE(by);
        EXPECT_NEAR((*by - Imath::V3d(-radius, 0, 0)).length(), 0, 1e-14);
    }
    PlannedViews other = plan_of(camera, {});
    other.setting.windows = windows_of_size(320, 180);
    EXPECT_NE(what_of<Error>([&] { add_planned(views, other, 9); }).find("its size"), std::string::npos);
    camera.world_to_camera = Imath::M44d().setScale(Imath::V3d(-1, 1, -1)); // as in Unreal
    add_planned(views, plan_of(camera, {}), 9);
    EXPECT_TRUE(views.frames.at(9).mirrored);
    EXPECT_FALSE(views.frames.at(8).mirrored);
    const Imath::M44d &to_world = views.frames.at(9).to_world;
    EXPECT_EQ(Imath::V3d(1, 0, 0) * to_world, Imath::V3d(-1, 0, 0));
    EXPECT_EQ(Imath::V3d(0, 0, -1) * to_world, Imath::V3d(0, 0, 1)); // forward was -z
    camera.world_to_camera.reset();
    EXPECT_NE(what_of<Error>([&] {
                  add_planned(views, plan_of(camera, {}), 9);
              }).find("center.exr: does not say where"),
              std::string::npos);
}

TEST_F(UsdViewsInFiles, FollowACameraOfUsdOverItsKeys) {
    const std::vector<double> times{1, 2, 3, 4, 4.5};
    Json frames;
    for (const double time : times) {
        const double angle = 0.35 * (time - 1);
        frames.push_back({{"time", time},
                          {"to_world",
                           {std::cos(angle), 0, -std::sin(angle), 0, 0, 1, 0, 0, std::sin(angle), 0,
                            std::cos(angle), 0, time, 0, 0, 1}},
                          {"focalLength", 40},
                          {"horizontalAperture", 36},
                          {"verticalAperture", 20.25},
                          {"focusDistance", 200},
                          {"fStop", 2 + (time - 1) * 4 / 7},
                          {"clippingRange", {2, 3000}}});
    }
    const std::string shot = put({{"metersPerUnit", 0.01},
                                  {"upAxis", "Z"},
                                  {"timeCodesPerSecond", 25},
                                  {"settings", nullptr},
                                  {"cameras", Json::array({Json{{"path", "/c"}, {"frames", frames}}})}},
                                 "shot.json");
    ShotRequest request{.camera = {.file = shot}, .size = Imath::V2i(640, 360)};
    const UsdViews views = views_of_shot(request, nobody);
    EXPECT_EQ(views.up_axis, 'Z');
    EXPECT_EQ(views.frames_per_second, 25);
    EXPECT_EQ(views.stage, ""); // JSON has no other attributes
    EXPECT_TRUE(views.keyed);
    ASSERT_EQ(views.frames.size(), times.size());
    const UsdCameras usd = read(views), of_shot = read_usd_cameras(shot, {});
    for (const double time : times) {
        const FilmCamera truth = film_camera(of_shot, of_shot.cameras[0], time);
        const FilmCamera found = film_camera(usd, camera_called(usd, ""), time);
        EXPECT_TRUE(found.world_to_camera.equalWithAbsError(truth.world_to_camera, 1e-12)) << time;
        EXPECT_NEAR(*found.fstop, *truth.fstop, 1e-12);
        EXPECT_NEAR(views.frames.at(time).radius, 4 / (2 * *truth.fstop), 1e-12); // 40 mm are 4 units
        EXPECT_EQ(clipping_range(usd, camera_called(usd, "view_3"), time), Imath::V2d(2, 3000));
    }
    request.lens.fstop = 1;
    EXPECT_NEAR(views_of_shot(request, nobody).frames.at(3).radius, 2, 1e-12);
    request.camera.frame = 3;
    EXPECT_EQ(views_of_shot(request, nobody).frames.size(), 1u);
    request.size.reset();
    EXPECT_NE(what_of<UsageError>([&] { views_of_shot(request, nobody); }).find("give `size`"),
              std::string::npos);
}

TEST_F(UsdViewsInFiles, GiveEachFileTheCameraOfItsName) {
    UsdViews views;
    add_planned(views, plan_of(some_camera(1), {{1, 0}, {0, 1}}), {});
    const StatedCameras stated({.file = put(stage_of(views))});
    std::optional<FilmCamera> centre = stated.of_centre("renders/center.exr");
    ASSERT_TRUE(centre);
    const auto rim = stated.of_views({"renders/view_1.exr", "renders/view_0.0001.exr"}, *centre);
    EXPECT_TRUE(centre->places);
    EXPECT_TRUE(rim[0]->name.ends_with("</sparselens/lens/view_1>"));
    EXPECT_TRUE(rim[1]->name.ends_with("</sparselens/lens/view_0>"));
    EXPECT_NE(what_of<UsageError>([&] {
                  stated.of_views({"view_0.exr", "up.exr"}, *centre);
              }).find("up.exr: "),
              std::string::npos);
    const auto others = stated.of_views({"right.exr", "up.exr"}, *centre);
    EXPECT_FALSE(centre->places); // only the lens
    EXPECT_FALSE(others[1]->places);
    EXPECT_FALSE(StatedCameras({}).of_centre("center.exr"));
    views.frames[1] = views.frames[0];
    views.frames[1].fstop *= 2;
    const std::string animated = put(stage_of(views));
    EXPECT_NE(what_of<UsageError>([&] {
                  StatedCameras({.file = animated}).of_centre("center.exr");
              }).find("is animated: give `camera_frame`"),
              std::string::npos);
    EXPECT_EQ(StatedCameras({.file = animated, .frame = 1}).of_centre("center.exr")->fstop, 5.6);
}

} // namespace
} // namespace sparselens
