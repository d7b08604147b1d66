#include "base/error.h"
#include "io/files/text_file.h"
#include "io/plan_file.h"
#include "plan/plan.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.5, .focal_px = 100, .focus = 5};

Plan plan_of(std::initializer_list<Imath::V2d> points) {
    Plan plan;
    for (const Imath::V2d &u : points) plan.views.push_back({u, PixelMask(Imath::Box2i({0, 0}, {0, 0})), 0});
    return plan;
}

// At (1,2,3), looking along world x, with world z up: its right is -y.
Camera turned_camera() {
    Camera camera;
    camera.world_to_camera = Imath::M44d(0, 0, 1, 0, -1, 0, 0, 0, 0, 1, 0, 0, 2, -3, -1, 1);
    return camera;
}

TEST(PlanCameras, StandBesideTheCentreInItsAxes) {
    const PlannedCameras planned = cameras_of(plan_of({{1, 0}, {0, -1}}), turned_camera(), lens, 200);
    ASSERT_EQ(planned.cameras.size(), 3u);
    EXPECT_EQ(planned.cameras[0].name, "center");
    EXPECT_EQ(planned.cameras[0].world_to_camera, turned_camera().world_to_camera);
    EXPECT_EQ(planned.cameras[2].name, "view_1");
    EXPECT_EQ(planned.cameras[1].offset, Imath::V2d(0.5, 0));
    EXPECT_EQ(planned.cameras[2].offset, Imath::V2d(0, -0.5));
    const auto place = [&](std::size_t i) {
        return camera_to_world_looking_back(*planned.cameras[i].world_to_camera);
    };
    EXPECT_EQ(place(0).translation(), Imath::V3d(1, 2, 3));
    EXPECT_EQ(place(1).translation(), Imath::V3d(1, 1.5, 3)); // half a unit to the right, along -y
    EXPECT_EQ(place(2).translation(), Imath::V3d(1, 2, 2.5)); // half a unit down
    EXPECT_EQ(place(0), Imath::M44d(0, -1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 1, 2, 3, 1)); // right, up, backward
}

TEST(PlanCameras, HaveTheScreenWindowOfTheCentre) {
    Camera camera;
    EXPECT_EQ(cameras_of({}, camera, lens, 200).window.width, 2);
    EXPECT_EQ(cameras_of({}, camera, lens, 200).window.centre, Imath::V2d(0, 0));
    camera.principal_point =
        Imath::V2d(0.25, 0.125); // right of and below the middle; the middle moves left and up
    EXPECT_EQ(cameras_of({}, camera, lens, 200).window.centre, Imath::V2d(-0.5, 0.25));
}

TEST(PlanCameras, AreWrittenAsJson) {
    const ScratchFolder folder;
    const std::string file = folder.file("cameras.json");
    write_cameras(file, cameras_of(plan_of({{1, 0}}), turned_camera(), lens, 200), {"c.exr", lens, 0.01});
    const auto json = nlohmann::json::parse(read_text_file(file));
    EXPECT_EQ(json.at("center"), "c.exr");
    EXPECT_EQ(json.at("lens_radius"), 0.5);
    EXPECT_EQ(json.at("focus_distance"), 5);
    EXPECT_EQ(json.at("metres_per_unit"), 0.01);
    EXPECT_EQ(json.at("screen_window").at("width"), 2);
    EXPECT_NEAR(double(json.at("horizontal_field_degrees")), 90, 1e-12);
    const auto &view = json.at("cameras").at(1);
    EXPECT_EQ(view.at("offset").at(0), 0.5);
    EXPECT_EQ(view.at("world_to_camera").at(3).at(0), 1.5);
    EXPECT_EQ(view.at("camera_to_world").at(3).at(1), 1.5);

    ThinLens far = lens;
    far.focus = std::numeric_limits<double>::infinity();
    write_cameras(file, cameras_of({}, {}, far, 200), {"c.exr", far, {}});
    const auto unknown = nlohmann::json::parse(read_text_file(file));
    EXPECT_TRUE(unknown.at("focus_distance").is_null());
    EXPECT_TRUE(unknown.at("metres_per_unit").is_null());
    EXPECT_TRUE(unknown.at("cameras").at(0).at("world_to_camera").is_null());
}

TEST(PlanCameras, AreWrittenAsCsv) {
    const ScratchFolder folder;
    const std::string file = folder.file("cameras.csv");
    for (const Camera &camera : {turned_camera(), Camera{}}) {
        write_cameras(file, cameras_of(plan_of({{1, 0}}), camera, lens, 200), {"c.exr", lens, {}});
        const std::string text = read_text_file(file);
        EXPECT_EQ(std::ranges::count(text, '\n'), 3);
        EXPECT_EQ(std::ranges::count(text, ','), 3 * (5 + 32));
        EXPECT_NE(text.find("\nview_0,0.5,0,2,0,0,"), text.npos) << text;
        EXPECT_EQ(text.find(",,,") == text.npos, camera.world_to_camera.has_value());
    }
    const auto wrong = [&] { write_cameras(folder.file("cameras.txt"), {}, {}); };
    EXPECT_NE(what_of<UsageError>(wrong).find("must end in .json or .csv"), std::string::npos);
}

} // namespace
} // namespace sparselens
