#include "view/resolve_lens.h"

#include "base/error.h"
#include "lens/f_number.h"

#include <cmath>
#include <string>

namespace sparselens {

namespace {

[[noreturn]] void refuse(const Camera &camera, const char *what, const char *option, const char *advice) {
    const auto reason = camera.unsure.find(option);
    throw UsageError(std::string(what) + " is unknown" +
                     (reason == camera.unsure.end() ? "" : " (" + reason->second + ")") + ": give " + advice);
}

double need(const std::optional<double> &value, const Camera &camera, const char *what, const char *option) {
    if (!value) refuse(camera, what, option, option);
    return *value;
}

} // namespace

Camera camera_with_options(const LensValues &values, Camera camera) {
    const auto put = [](std::optional<double> &value, const std::optional<double> &given) {
        if (given) value = given;
    };
    // The file's focus is in metres: with another scene unit it is as many units more or fewer.
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
    if (radius) return *radius;
    if (!camera.fstop) refuse(camera, "the aperture", "--fstop", "--fstop or --lens-radius");
    refuse(camera, "the focal length", "--focal-length", "--focal-length");
}

double resolve_focal_px(const Camera &camera, const Windows &windows) {
    const auto focal_px = focal_length_px(camera, windows.display_width());
    if (focal_px) return *focal_px;
    need(camera.focal_length_mm, camera, "the focal length", "--focal-length");
    refuse(camera, "the sensor width", "--sensor-width", "--sensor-width");
}

ThinLens resolve_lens(const Camera &camera, const Windows &windows) {
    ThinLens lens{.radius = resolve_radius(camera), .pixel_aspect = windows.pixel_aspect};
    if (lens.radius == 0) return lens;
    lens.focal_px = resolve_focal_px(camera, windows);
    lens.focus = need(camera.focus_distance, camera, "the focus distance", "--focus-distance");
    return lens;
}

} // namespace sparselens
