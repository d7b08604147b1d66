#include "options/lens_options.h"

#include "harness/words.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <map>

namespace sparselens {

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

void add_lens_options(CLI::App &app, LensValues &options) {
    const auto positive = number("a number above 0");
    const auto positive_or_inf = number("a number above 0, or inf", {.infinity_allowed = true});
    const auto not_negative = number("a number of at least 0", {.zero_allowed = true});
    const auto add = [&](const char *name, std::optional<double> &value, const char *unit, const char *help) {
        return app.add_option(name, value, help)->type_name(unit)->group("Lens");
    };
    add("--focal-length", options.focal_length_mm, "MM", "Focal length")->check(positive);
    add("--sensor-width", options.sensor_width_mm, "MM",
        "Width of the film back; it spans the display window")
        ->check(positive);
    CLI::Option *fstop = add("--fstop", options.fstop, "N", "F-number, or inf")->check(positive_or_inf);
    add("--lens-radius", options.lens_radius, "R",
        "Radius of the aperture, in scene units; instead of --fstop")
        ->check(not_negative)
        ->excludes(fstop);
    add("--focus-distance", options.focus_distance, "D", "Focus distance, in scene units, or inf")
        ->check(positive_or_inf);
    add("--scene-unit", options.scene_unit, "METRES", "Length of a scene unit (default: 1)")->check(positive);
}

void add_depth_options(CLI::App &app, DepthOptions &options) {
    const std::map<std::string, DepthMeaning> meanings{{"z", DepthMeaning::planar},
                                                       {"distance", DepthMeaning::distance},
                                                       {"inverse", DepthMeaning::inverse},
                                                       {"negative", DepthMeaning::negative},
                                                       {"normalized", DepthMeaning::normalized},
                                                       {"hyperbolic", DepthMeaning::hyperbolic}};
    app.add_option(
           "--depth", options.meaning,
           "What depth channels hold: z: planar; distance: from the camera along the ray; inverse: 1 / z; "
           "negative: -z; normalized: 0 at --near to 1 at --far; hyperbolic: the same, but linear in 1 / z, "
           "as in a "
           "depth buffer (default: z)")
        ->type_name("z|distance|inverse|negative|normalized|hyperbolic")
        ->transform(words(meanings))
        ->group("Lens");
    app.add_option(
           "--near", options.near,
           "With --depth normalized and hyperbolic, the depth of 0 (default: the near attribute of the file)")
        ->type_name("D")
        ->check(number("a number above 0"))
        ->group("Lens");
    app.add_option("--far", options.far,
                   "Depths beyond this are sky; with --depth normalized and hyperbolic, the depth of 1 "
                   "(default: 1e10)")
        ->type_name("D")
        ->check(number("a number above 0", {.infinity_allowed = true}))
        ->group("Lens");
    app.add_option("--depth-channel", options.picture.depth,
                   "Depth channel (default: the first of Z, depth.Z and *.Depth.Z)")
        ->type_name("NAME")
        ->group("Lens");
    add_picture_choice(app, options.picture);
}

void add_picture_choice(CLI::App &app, PictureChoice &picture) {
    app.add_option("--stereo-view", picture.stereo_view,
                   "Stereo view to read, e.g. right (default: the file's first)")
        ->type_name("NAME")
        ->group("Lens");
    app.add_option("--layer", picture.layer,
                   "Picture to read of a file that holds several, such as a view layer of Blender: its "
                   "beauty, depth and passes (default: the only one)")
        ->type_name("NAME")
        ->group("Lens");
}

} // namespace sparselens
