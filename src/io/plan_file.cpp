#include "io/plan_file.h"

#include "base/error.h"
#include "base/grid.h"
#include "io/exr/exr_flat.h"
#include "io/files/file_stream.h"
#include "io/files/text_file.h"
#include "plan/disocclusion.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

namespace sparselens {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json; // for writing
using Given = nlohmann::json;        // for reading

Json json_of(const Imath::Box2i &box) { return {box.min.x, box.min.y, box.max.x, box.max.y}; }

// JSON has no infinity.
Json json_of(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Imath::Box2i bounds_of(const std::vector<Imath::Box2i> &boxes) {
    Imath::Box2i all;
    for (const Imath::Box2i &box : boxes) all.extendBy(box);
    return all;
}

std::string write_mask(const std::string &plan_path, const std::string &folder, const std::string &name,
                       const PixelMask &mask, const Windows &windows) {
    make_folder(folder);
    Image image(windows, {{"A", PixelType::half}});
    std::ranges::copy(mask.set, image.plane(0).begin());
    const fs::path file = fs::path(folder) / (name + ".exr");
    write_flat_exr(file.string(), image, {});
    const fs::path named =
        plan_path == "-" ? file : file.lexically_proximate(fs::path(plan_path).parent_path());
    return named.generic_string(); // other systems read the plan, too
}

Json json_of(const PlannedView &view, const std::string &name, const ThinLens &lens) {
    const std::vector<Imath::Box2i> rectangles = rectangles_over(view.mask);
    Json json{{"name", name},
              {"lens_point", {view.u.x, view.u.y}},
              {"position", {lens.radius * view.u.x, lens.radius * view.u.y}},
              {"share", double(view.mask.count()) / double(view.mask.set.size())},
              {"uncovered", view.uncovered},
              {"data_window", json_of(bounds_of(rectangles))},
              {"rectangles", Json::array()}};
    for (const Imath::Box2i &box : rectangles) json["rectangles"].push_back(json_of(box));
    return json;
}

double pixels_of(const Imath::Box2i &box) {
    return (double(box.max.x) - box.min.x + 1) * (double(box.max.y) - box.min.y + 1);
}

int whole_number(const Given &json) {
    const double number = json.get<double>();
    constexpr double most = std::numeric_limits<int>::max();
    if (!(std::abs(number) <= most && std::trunc(number) == number))
        throw Error("a corner of a window is " + shown_in_message(json) + ", not a pixel");
    return int(number);
}

Imath::Box2i box_of(const Given &json) {
    const Imath::Box2i box({whole_number(json.at(0)), whole_number(json.at(1))},
                           {whole_number(json.at(2)), whole_number(json.at(3))});
    constexpr double most = 1 << 28; // pixels: no picture has more
    if (box.isEmpty() || pixels_of(box) > most) throw Error("a window is empty or too large");
    return box;
}

// Rectangles lie in the window of their view. A plan by ldi-plan has at most 64 of them, which may overlap; more are
// accepted if they are small.
std::vector<Imath::Box2i> rectangles_of(const Given &view, const Imath::Box2i &window) {
    std::vector<Imath::Box2i> rectangles;
    double pixels = 0;
    for (const Given &rectangle : view.at("rectangles")) {
        rectangles.push_back(box_of(rectangle));
        pixels += pixels_of(rectangles.back());
        if (!window.intersects(rectangles.back().min) || !window.intersects(rectangles.back().max))
            throw Error("a rectangle is not in the data_window of its view");
    }
    if (pixels > 64 * pixels_of(window)) throw Error("the rectangles of a view overlap too often");
    return rectangles;
}

RequestedView view_of(const Given &json, const fs::path &folder) {
    const Given &u = json.at("lens_point");
    RequestedView view{{u.at(0), u.at(1)}, box_of(json.at("data_window")), {}, {}};
    view.rectangles = rectangles_of(json, view.window);
    if (json.contains("mask")) view.mask = (folder / json.at("mask").get<std::string>()).string();
    return view;
}

} // namespace

void write_plan(const std::string &path, const Plan &plan, const PlanSetting &setting,
                const std::string &masks) {
    const ThinLens &lens = setting.lens;
    const char *advice = plan.views.empty() ? "none" : plan.full_views ? "full" : "planned";
    Json json{
        {"version", 1},
        {"center", setting.centre},
        {"center_supersample", setting.across},
        {"display_window", json_of(setting.windows.display)},
        {"data_window", json_of(setting.windows.data)},
        {"lens",
         {{"radius", lens.radius}, {"focal_px", lens.focal_px}, {"focus_distance", json_of(lens.focus)}}},
        {"margin", setting.margin},
        {"share", plan.share()},
        {"advice", advice},
        {"noise_db", json_of(-10 * std::log10(plan.noise))},
        {"edges", plan.edges},
        {"supersample", plan.supersample},
        {"overscan",
         {{"left", plan.overscan.left},
          {"top", plan.overscan.top},
          {"right", plan.overscan.right},
          {"bottom", plan.overscan.bottom}}},
        {"views", Json::array()}};
    if (const auto &rays = setting.division)
        json["rays"] = {{"views", rays->views},
                        {"supersample", rays->supersample},
                        {"samples", rays->samples},
                        {"per_render", rays->per_render},
                        {"noise_db", json_of(-10 * std::log10(rays->noise))},
                        {"alone", rays->alone}};
    if (const auto &need = setting.moments) {
        json["moments"] = need->moments;
        json["motion"] = need->motion;
    }
    for (std::size_t k = 0; k < plan.views.size(); ++k) {
        const std::string name = fmt::format("view_{}", k);
        Json view = json_of(plan.views[k], name, lens);
        if (!masks.empty()) view["mask"] = write_mask(path, masks, name, plan.views[k].mask, setting.windows);
        json["views"].push_back(view);
    }
    write_text_file(path, json.dump(1) + "\n");
}

PixelMask mask_of(const RequestedView &view) {
    PixelMask mask(view.window);
    if (view.mask.empty()) {
        for (const Imath::Box2i &box : view.rectangles)
            for (int y = box.min.y; y <= box.max.y; ++y)
                std::fill_n(&mask.set[mask.index(Imath::V2i(box.min.x, y))], Grid(box).width(),
                            std::uint8_t(1));
        return mask;
    }
    const Image image = read_flat_exr(view.mask).image;
    const std::size_t alpha = find_channel(image.channels, "A");
    if (alpha == npos) throw Error(view.mask + ": a mask has the channel A, which is not here");
    for (int y = mask.data.min.y; y <= mask.data.max.y; ++y)
        for (int x = mask.data.min.x; x <= mask.data.max.x; ++x)
            if (image.windows.data.intersects(Imath::V2i(x, y)))
                mask.set[mask.index(Imath::V2i(x, y))] = image.at(alpha, x, y) > 0;
    return mask;
}

PlanRequest read_plan(const std::string &path) {
    try {
        const Given json = read_json_file(path);
        PlanRequest request{box_of(json.at("display_window")), {}, {}};
        if (json.contains("center_supersample")) request.across = whole_number(json.at("center_supersample"));
        for (const Given &view : json.at("views"))
            request.views.push_back(view_of(view, fs::path(path).parent_path()));
        return request;
    } catch (const nlohmann::json::exception &error) {
        throw Error(fmt::format("{}: not a plan of ldi-plan: {}", display_name(path), error.what()));
    } catch (const Error &error) {
        const std::string what = error.what();
        throw Error(what.starts_with(display_name(path)) ? what : display_name(path) + ": " + what);
    }
}

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
