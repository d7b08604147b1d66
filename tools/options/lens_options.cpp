#include "options/lens_options.h"

#include "base/error.h"
#include "harness/words.h"

#include <cmath>
#include <limits>
#include <map>

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

CLI::Validator number(const std::string &what, NumberRange range) {
    const auto check = [=](const std::string &text) -> std::string {
        double value = 0;
        const bool is_number = CLI::detail::lexical_cast(text, value) && !std::isnan(value);
        const bool in_range = value > 0 || (range.zero_allowed && value == 0);
        if (is_number && in_range && (range.infinity_allowed || std::isfinite(value))) return {};
        return "'" + text + "' is not " + what;
    };
    return CLI::Validator(check, "");
}

void add_lens_options(CLI::App &app, LensOptions &options) {
    const auto positive = number("a number above 0");
    const auto positive_or_inf = number("a number above 0, or inf", {.infinity_allowed = true});
    const auto not_negative = number("a number of at least 0", {.zero_allowed = true});
    const auto add = [&](const char *name, std::optional<double> &value, const char *unit, const char *help) {
        return app.add_option(name, value, help)->type_name(unit)->group("Lens");
    };
    add("--focal-length", options.focal_length_mm, "MM", "Focal length")->check(positive);
    add("--sensor-width", options.sensor_width_mm, "MM", "Width of the film back (spans the display window)")
        ->check(positive);
    CLI::Option *fstop = add("--fstop", options.fstop, "N", "F-number, or inf")->check(positive_or_inf);
    add("--lens-radius", options.lens_radius, "R", "Radius of the aperture, scene units (instead of --fstop)")
        ->check(not_negative)
        ->excludes(fstop);
    add("--focus-distance", options.focus_distance, "D", "Focus distance, scene units, or inf")
        ->check(positive_or_inf);
    add("--scene-unit", options.scene_unit, "METRES", "Length of a scene unit (1)")->check(positive);
}

void add_depth_options(CLI::App &app, DepthOptions &options) {
    const std::map<std::string, DepthMeaning> meanings{{"z", DepthMeaning::planar},
                                                       {"distance", DepthMeaning::distance},
                                                       {"inverse", DepthMeaning::inverse}};
    app.add_option("--depth", options.meaning, "What depth channels hold: z, distance or inverse (z)")
        ->type_name("z|distance|inverse")
        ->transform(words(meanings))
        ->group("Lens");
    app.add_option("--far", options.far, "Depth from which on there is only sky, as the far clip (1e10)")
        ->type_name("D")
        ->check(number("a number above 0", {.infinity_allowed = true}))
        ->group("Lens");
    app.add_option("--depth-channel", options.channel, "Depth channel (else Z, depth.Z, *.Depth.Z are tried)")
        ->type_name("NAME")
        ->group("Lens");
    add_stereo_option(app, options.view);
}

void add_stereo_option(CLI::App &app, std::string &view) {
    app.add_option("--stereo-view", view, "View of stereo files to read, as right (their default one)")
        ->type_name("NAME")
        ->group("Lens");
}

Camera camera_with_options(const LensOptions &options, Camera camera) {
    const auto put = [](std::optional<double> &value, const std::optional<double> &option) {
        if (option) value = option;
    };
    // The file's focus is in metres: with another scene unit it is as many units more or fewer.
    if (options.scene_unit && camera.focus_distance)
        *camera.focus_distance *= camera.metres_per_unit.value_or(1) / *options.scene_unit;
    put(camera.focal_length_mm, options.focal_length_mm);
    put(camera.sensor_width_mm, options.sensor_width_mm);
    put(camera.focus_distance, options.focus_distance);
    put(camera.metres_per_unit, options.scene_unit);
    put(camera.fstop, options.fstop);
    complete_field(camera);
    if (options.lens_radius && *options.lens_radius == 0)
        camera.fstop = std::numeric_limits<double>::infinity();
    else if (options.lens_radius && camera.focal_length_mm)
        camera.fstop =
            *camera.focal_length_mm / 1000 / (2 * *options.lens_radius) / camera.metres_per_unit.value_or(1);
    return camera;
}

std::optional<double> lens_radius_of(const Camera &camera) {
    if (camera.fstop && std::isinf(*camera.fstop)) return 0.0;
    if (!camera.fstop || !camera.focal_length_mm) return {};
    return *camera.focal_length_mm / 1000 / (2 * *camera.fstop) / camera.metres_per_unit.value_or(1);
}

double resolve_radius(const LensOptions &options, const Camera &camera) {
    if (options.lens_radius) return *options.lens_radius;
    if (!camera.fstop) refuse(camera, "the aperture", "--fstop", "--fstop or --lens-radius");
    if (!std::isinf(*camera.fstop))
        need(camera.focal_length_mm, camera, "the focal length", "--focal-length");
    return *lens_radius_of(camera);
}

double resolve_focal_px(const Camera &camera, const Windows &windows) {
    const auto focal_px = focal_length_px(camera, windows.display_width());
    if (focal_px) return *focal_px;
    need(camera.focal_length_mm, camera, "the focal length", "--focal-length");
    refuse(camera, "the sensor width", "--sensor-width", "--sensor-width");
}

ThinLens resolve_lens(const LensOptions &options, const Camera &camera, const Windows &windows) {
    ThinLens lens{.radius = resolve_radius(options, camera), .pixel_aspect = windows.pixel_aspect};
    if (lens.radius == 0) return lens;
    lens.focal_px = resolve_focal_px(camera, windows);
    lens.focus = need(camera.focus_distance, camera, "the focus distance", "--focus-distance");
    return lens;
}

} // namespace sparselens
