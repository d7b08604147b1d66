#include "io/usd/usd_views.h"

#include "base/error.h"
#include "io/files/file_stream.h"
#include "io/files/text_file.h"
#include "io/usd/usd_script.h"
#include "plan/plan.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

using Json = nlohmann::ordered_json;

// Files hold matrices as floats, whose axes are not quite perpendicular.
Imath::M44d rigid(Imath::M44d m) {
    const auto axis = [&](int row) { return Imath::V3d(m[row][0], m[row][1], m[row][2]); };
    const Imath::V3d back = axis(2).normalized();
    const Imath::V3d up = (axis(1) - axis(1).dot(back) * back).normalized();
    const Imath::V3d right = up.cross(back);
    const Imath::V3d axes[] = {right, up, back};
    for (int row = 0; row < 3; ++row)
        for (int k = 0; k < 3; ++k) m[row][k] = axes[row][k];
    return m;
}

// JSON has no infinity. No number is -0.
Json json_of(double value) { return std::isfinite(value) ? Json(value + 0.0) : Json(nullptr); }
Json json_of(const Imath::V2d &v) { return {json_of(v.x), json_of(v.y)}; }
Json json_of(const Imath::M44d &m) {
    Json numbers = Json::array();
    for (int i = 0; i < 16; ++i) numbers.push_back(json_of(m[i / 4][i % 4]));
    return numbers;
}

Json json_of(const UsdViews &views, const UsdLensFrame &frame) {
    // USD counts apertures and focal lengths in tenths of a scene unit.
    const auto tenths = [&](double mm) { return json_of(mm / (100 * views.metres_per_unit)); };
    const double shape = double(views.windows.display_height()) /
                         (double(views.windows.display_width()) * double(views.windows.pixel_aspect));
    return {{"clippingRange", json_of(frame.clipping)},
            {"focalLength", tenths(frame.focal_length_mm)},
            {"focusDistance", json_of(std::isfinite(frame.focus_distance) ? frame.focus_distance : 0)},
            {"horizontalAperture", tenths(frame.film_width_mm)},
            {"horizontalApertureOffset", tenths(frame.offset_mm.x)},
            {"verticalAperture", tenths(frame.film_width_mm * shape)},
            {"verticalApertureOffset", tenths(frame.offset_mm.y)},
            {"sparselens:focusDistance", json_of(frame.focus_distance)},
            {"sparselens:fStop", json_of(frame.fstop)}};
}

// In parts of the display window, y up; null if that is all of it.
Json data_window_of(const Windows &windows) {
    if (windows.data == windows.display) return nullptr;
    const double w = windows.display_width(), h = windows.display_height();
    const Imath::V2i from = windows.data.min - windows.display.min,
                     to = windows.data.max - windows.display.min;
    return {from.x / w, 1 - (to.y + 1) / h, (to.x + 1) / w, 1 - from.y / h};
}

} // namespace

UsdLensFrame usd_lens_frame(const Camera &camera, const ThinLens &lens, int display_width,
                            const std::string &file) {
    if (!camera.world_to_camera)
        throw Error(file + ": does not say where its camera stands (worldToCamera): give its `camera`");
    constexpr double any_film = 36; // mm, where only the field of view is known
    const double mm = 1 / (1000 * camera.metres_per_unit.value_or(1)); // in scene units
    const double focal_length = camera.focal_length_mm.value_or(any_film * lens.focal_px / display_width);
    const double width = camera.sensor_width_mm.value_or(focal_length * display_width / lens.focal_px);
    const Imath::V2d axis = camera.principal_point.value_or(Imath::V2d(0, 0));
    UsdLensFrame frame;
    // Camera space (x right, y up, z forward) is left-handed, so a right-handed world is mirrored on the way to it.
    frame.mirrored = camera.world_to_camera->determinant() > 0;
    const Imath::M44d mirror = Imath::M44d().setScale(Imath::V3d(1, 1, frame.mirrored ? -1 : 1));
    frame.to_world = rigid(camera_to_world_looking_back(mirror * *camera.world_to_camera));
    frame.focal_length_mm = focal_length;
    frame.film_width_mm = width;
    frame.offset_mm = Imath::V2d(0 - axis.x, axis.y) * width;
    frame.radius = lens.radius;
    frame.fstop =
        camera.fstop.value_or(fstop_of(lens.radius, focal_length, camera.metres_per_unit.value_or(1)));
    frame.focus_distance = lens.focus;
    frame.clipping = {10 * mm, 1e7 * mm};
    return frame;
}

void add_lens_points(UsdViews &views, const std::vector<Imath::V2d> &points) {
    const auto tidy = [](double x) {
        return std::round(x * 1e15) / 1e15 + 0.0;
    }; // no 6e-17 in the file, and no -0
    for (const Imath::V2d &exact : points) {
        const Imath::V2d point(tidy(exact.x), tidy(exact.y));
        if (std::ranges::none_of(views.lens_points,
                                 [&](const Imath::V2d &p) { return (p - point).length() < 1e-9; }))
            views.lens_points.push_back(point);
    }
}

std::string usd_views_json(const UsdViews &views) {
    Json points{{"center", nullptr}}, frames = Json::array();
    for (std::size_t k = 0; k < views.lens_points.size(); ++k)
        points[fmt::format("view_{}", k)] = json_of(views.lens_points[k]);
    for (const auto &[time, frame] : views.frames)
        frames.push_back({{"time", time},
                          {"to_world", json_of(frame.to_world)},
                          {"radius", json_of(frame.radius)},
                          {"camera", json_of(views, frame)}});
    const Json all{{"source", display_name(views.source)},
                   {"stage", views.stage},
                   {"camera", views.camera},
                   {"metersPerUnit", views.metres_per_unit},
                   {"upAxis", std::string(1, views.up_axis)},
                   {"timeCodesPerSecond", views.frames_per_second},
                   {"keyed", views.keyed},
                   {"resolution", {views.windows.display_width(), views.windows.display_height()}},
                   {"pixel_aspect", views.windows.pixel_aspect},
                   {"data_window", data_window_of(views.windows)},
                   {"points", points},
                   {"frames", frames}};
    return all.dump(-1, ' ', true, Json::error_handler_t::replace);
}

void write_usd_views(const std::string &path, const UsdViews &views) {
    write_text_file(path, run_usd_script({"write", "--", path}, usd_views_json(views), path));
}

} // namespace sparselens
