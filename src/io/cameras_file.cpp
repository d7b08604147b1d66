#include "io/cameras_file.h"

#include "base/error.h"
#include "io/files/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>

namespace sparselens {

namespace {

using Json = nlohmann::ordered_json;
using Matrix = std::optional<Imath::M44d>;

Json json_of(const Imath::V2d &v) { return {v.x, v.y}; }

Json json_of(const Matrix &matrix) {
    if (!matrix) return nullptr;
    Json rows = Json::array();
    for (int row = 0; row < 4; ++row)
        rows.push_back({(*matrix)[row][0], (*matrix)[row][1], (*matrix)[row][2], (*matrix)[row][3]});
    return rows;
}

Matrix placement_of(const PlannedCamera &camera) {
    if (!camera.world_to_camera) return {};
    return camera_to_world_looking_back(*camera.world_to_camera);
}

std::string json_text(const PlannedCameras &planned, const CamerasSetting &setting) {
    const ScreenWindow &window = planned.window;
    const double focus = setting.lens.focus;
    Json json{{"version", 1},
              {"center", setting.centre},
              {"lens_radius", setting.lens.radius},
              {"focus_distance", std::isfinite(focus) ? Json(focus) : Json(nullptr)}, // JSON has no infinity
              {"metres_per_unit", setting.metres_per_unit ? Json(*setting.metres_per_unit) : Json(nullptr)},
              {"screen_window", {{"width", window.width}, {"center", json_of(window.centre)}}},
              {"horizontal_field_degrees", 2 * std::atan(window.width / 2) * 180 / std::numbers::pi},
              {"cameras", Json::array()}};
    for (const PlannedCamera &camera : planned.cameras)
        json["cameras"].push_back({{"name", camera.name},
                                   {"offset", json_of(camera.offset)},
                                   {"world_to_camera", json_of(camera.world_to_camera)},
                                   {"camera_to_world", json_of(placement_of(camera))}});
    return json.dump(1) + "\n";
}

std::string csv_columns(const char *name) {
    std::string text;
    for (int i = 0; i < 16; ++i) text += fmt::format(",{}_{}{}", name, i / 4, i % 4);
    return text;
}

std::string csv_columns(const Matrix &matrix) {
    std::string text;
    for (int i = 0; i < 16; ++i) text += matrix ? fmt::format(",{}", (*matrix)[i / 4][i % 4]) : ",";
    return text;
}

std::string csv_text(const PlannedCameras &planned) {
    const ScreenWindow &window = planned.window;
    std::string text =
        "name,offset_x,offset_y,screen_window_width,screen_window_center_x,screen_window_center_y" +
        csv_columns("world_to_camera") + csv_columns("camera_to_world") + "\n";
    for (const PlannedCamera &camera : planned.cameras)
        text += fmt::format("{},{},{},{},{},{}", camera.name, camera.offset.x, camera.offset.y, window.width,
                            window.centre.x, window.centre.y) +
                csv_columns(camera.world_to_camera) + csv_columns(placement_of(camera)) + "\n";
    return text;
}

} // namespace

void write_cameras(const std::string &path, const PlannedCameras &cameras, const CamerasSetting &setting) {
    if (path.ends_with(".json"))
        write_text_file(path, json_text(cameras, setting));
    else if (path.ends_with(".csv"))
        write_text_file(path, csv_text(cameras));
    else
        throw UsageError("`cameras=" + path + "`: the name must end in .json or .csv");
}

} // namespace sparselens
