#include "lab/tracing/camera_json.h"

#include "base/error.h"
#include "io/files/text_file.h"

#include <nlohmann/json.hpp>

#include <limits>

namespace sparselens::lab {

namespace {

// Infinity is null.
double number(const nlohmann::json &json, const char *key) {
    const auto &value = json.at(key);
    return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

CameraSummary summary_of(const nlohmann::json &json) {
    CameraSummary camera;
    camera.width = json.at("width");
    camera.height = json.at("height");
    camera.focal_mm = number(json, "focal_mm");
    camera.sensor_width_mm = number(json, "sensor_width_mm");
    camera.focus_distance = number(json, "focus_distance");
    camera.lens_radius = number(json, "lens_radius");
    for (const auto &point : json.at("views"))
        camera.views.emplace_back(double(point.at(0)), double(point.at(1)));
    camera.view_samples = json.at("view_spp");
    camera.supersample = json.value("supersample", 1);
    camera.seconds = json.at("seconds").get<std::map<std::string, double>>();
    if (json.contains("others"))
        for (const auto &other : json.at("others"))
            camera.others.push_back({other.at("file"), other.at("renderer"), other.at("processor"),
                                     other.at("budget"), other.at("rays")});
    return camera;
}

} // namespace

CameraSummary read_camera_summary(const std::filesystem::path &folder) {
    const std::filesystem::path path = folder / "camera.json";
    try {
        return summary_of(read_json_file(path.string()));
    } catch (const nlohmann::json::exception &error) {
        throw Error(path.string() + ": " + error.what());
    }
}

} // namespace sparselens::lab
