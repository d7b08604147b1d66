#include "view/resolve_lens.h"

#include "base/error.h"
#include "view/view_mapping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace sparselens {

namespace {

using LensNumber = NumberParameter<LensValues>;
constexpr std::array numbers{
    LensNumber{"focal-length", "MM", "Focal length, in millimetres (default: that of the input)",
               &LensValues::focal_length_mm, above_0},
    LensNumber{"sensor-width", "MM",
               "Width of the sensor, in millimetres, across the display window (default: that of the input)",
               &LensValues::sensor_width_mm, above_0},
    LensNumber{"fstop", "N", "F-number, or inf (default: that of the input)", &LensValues::fstop,
               above_0_or_inf},
    LensNumber{"lens-radius", "R", "Radius of the aperture, in scene units; instead of `fstop`",
               &LensValues::lens_radius, at_least_0},
    LensNumber{"focus-distance", "D", "Focus distance, in scene units, or inf (default: that of the input)",
               &LensValues::focus_distance, above_0_or_inf},
    LensNumber{"scene-unit", "METRES",
               "Length of a scene unit, in metres (default: that of the input, else 1)",
               &LensValues::scene_unit, above_0},
};

// Collects the unknown values, the reasons, and the parameters to give.
class Missing {
public:
    explicit Missing(const Camera &camera) : camera_(camera) {}

    void add(const std::string &what, const std::string &parameter, const char *or_else = "") {
        const auto reason = camera_.unsure.find(parameter);
        const std::string why = reason == camera_.unsure.end() ? "" : " (" + reason->second + ")";
        const std::string text = what + " is unknown" + why + ": give `" + parameter + "`" + or_else;
        if (text_.find(text) == std::string::npos) text_ += (text_.empty() ? "" : "; ") + text;
    }
    void add_focal_length() { add("the focal length", "focal_length"); }

    // Adds the values that the radius of the aperture needs.
    void add_radius() {
        if (!camera_.fstop)
            add("the aperture", "fstop", " or `lens_radius`");
        else
            add_focal_length();
    }

    // Adds the values that the focal length in pixels needs.
    void add_focal_px() {
        if (!camera_.focal_length_mm) add_focal_length();
        if (!camera_.sensor_width_mm) add("the sensor width", "sensor_width");
    }

    void refuse() const {
        if (!text_.empty()) throw UsageError(text_);
    }

private:
    const Camera &camera_;
    std::string text_;
};

} // namespace

std::span<const LensNumber> lens_numbers() { return numbers; }

Camera camera_with_options(const LensValues &values, Camera camera) {
    const auto put = [](std::optional<double> &value, const std::optional<double> &given) {
        if (given) value = given;
    };
    // The focus distance of the file keeps its length in metres.
    if (values.scene_unit && camera.focus_distance)
        *camera.focus_distance *= camera.metres_per_unit.value_or(1) / *values.scene_unit;
    put(camera.focal_length_mm, values.focal_length_mm);
    put(camera.sensor_width_mm, values.sensor_width_mm);
    put(camera.focus_distance, values.focus_distance);
    put(camera.metres_per_unit, values.scene_unit);
    put(camera.fstop, values.fstop);
    complete_field(camera);
    if (values.fstop) camera.lens_radius.reset();
    put(camera.lens_radius, values.lens_radius);
    if (values.lens_radius && (*values.lens_radius == 0 || camera.focal_length_mm))
        camera.fstop = fstop_of(*values.lens_radius, camera.focal_length_mm.value_or(1),
                                camera.metres_per_unit.value_or(1));
    return camera;
}

std::optional<double> lens_radius_of(const Camera &camera) {
    if (camera.lens_radius) return camera.lens_radius;
    if (camera.fstop && std::isinf(*camera.fstop)) return 0.0;
    if (!camera.fstop || !camera.focal_length_mm) return {};
    return radius_of(*camera.fstop, *camera.focal_length_mm, camera.metres_per_unit.value_or(1));
}

double resolve_radius(const Camera &camera) {
    const std::optional<double> radius = lens_radius_of(camera);
    Missing missing(camera);
    if (!radius) missing.add_radius();
    missing.refuse();
    return *radius;
}

double resolve_focal_px(const Camera &camera, const Windows &windows) {
    const auto focal_px = focal_length_px(camera, windows.display_width());
    Missing missing(camera);
    if (!focal_px) missing.add_focal_px();
    missing.refuse();
    return *focal_px;
}

std::optional<double> disparity_scale(const Camera &camera, const Windows &windows, bool required) {
    const bool known = lens_radius_of(camera) && focal_length_px(camera, windows.display_width());
    if (!known && !required) return {};
    const double radius = resolve_radius(camera);
    return radius > 0 ? radius * resolve_focal_px(camera, windows) : 0;
}

ThinLens resolve_lens(const Camera &camera, const Windows &windows) {
    const std::optional<double> radius = lens_radius_of(camera);
    if (radius == 0.0) return {.radius = 0, .pixel_aspect = windows.pixel_aspect};
    const auto focal_px = focal_length_px(camera, windows.display_width());
    Missing missing(camera);
    if (!radius) missing.add_radius();
    if (!focal_px) missing.add_focal_px();
    if (!camera.focus_distance) missing.add("the focus distance", "focus_distance");
    missing.refuse();
    const double at_1 = *radius * *focal_px, at_infinity = at_1 / *camera.focus_distance;
    if (constexpr double most = 1e30; !(std::max(at_1, at_infinity) <= most)) // so that floats hold CoCs
        throw UsageError("the blur would be more than 1e30 pixels wide: check the aperture, `focal_length`, "
                         "`focus_distance` and `scene_unit`");
    return {.radius = *radius,
            .focal_px = *focal_px,
            .focus = *camera.focus_distance,
            .pixel_aspect = windows.pixel_aspect};
}

std::optional<ThinLens> known_lens(const Camera &camera, const Windows &windows) {
    const std::optional<double> radius = lens_radius_of(camera);
    const bool known = radius && focal_length_px(camera, windows.display_width()) && camera.focus_distance;
    return known || radius == 0.0 ? std::optional(resolve_lens(camera, windows)) : std::nullopt;
}

double views_radius(const Camera &camera) {
    double widest = 0;
    for (const Imath::V2d &point : camera.lens_points) widest = std::max(widest, point.length());
    return widest;
}

bool sees_past_views(const Camera &camera, const ThinLens &lens) {
    const double widest = views_radius(camera);
    return widest > 0 && lens.radius > 1.001 * widest;
}

LensLooks resolve_looks(const LookValues &values, const Camera &camera, const ThinLens &lens,
                        const Windows &windows) {
    LensLooks looks;
    values.act({lens, camera.focal_length_mm, camera.metres_per_unit.value_or(1)}, looks);
    looks.aperture.picture = values.picture;
    if (camera.principal_point)
        looks.axis = in_pixels(*camera.principal_point, windows) - in_pixels({0, 0}, windows);
    return looks;
}

} // namespace sparselens
