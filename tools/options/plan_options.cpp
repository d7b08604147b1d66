#include "options/plan_options.h"

#include "base/text.h"
#include "harness/commands/file_arguments.h"
#include "harness/tool.h"
#include "options/picture_options.h"
#include "options/warp_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace sparselens {

namespace {

CLI::Validator camera_file() {
    return CLI::Validator(
        [](std::string &name) {
            return name.ends_with(".json") || name.ends_with(".csv") || holds_all_frames(name)
                       ? ""
                       : "must end in .json, .csv, .usd, .usda or .usdc, not '" + name + "'";
        },
        "");
}

Imath::V2i size_of(const std::string &text) {
    const std::size_t x = text.find('x');
    const auto width = number_of<int>(text.substr(0, x)),
               height = number_of<int>(x == text.npos ? "" : text.substr(x + 1));
    const auto is_side = [](const std::optional<int> &side) { return side >= 1 && side <= 1 << 20; };
    if (!is_side(width) || !is_side(height))
        throw CLI::ValidationError("--size", "must be WIDTHxHEIGHT (e.g. 640x360), not '" + text + "'");
    return {*width, *height};
}

} // namespace

void add_plan_options(CLI::App &app, PlanCommand &options) {
    app.add_option("CENTER", options.centre,
                   "Centre view with colour and depth (EXR). %s in its name: the centre views of a shutter's "
                   "moments, from which the number of moments is computed. Without CENTER, --camera and "
                   "--cameras write only cameras")
        ->type_name("");
    app.add_option("-o,--output", options.output, "Plan to write; - for standard output")
        ->type_name("PLAN.json");
    app.add_option("--masks", options.masks,
                   "Folder for one mask per view; its A is 1 in the pixels to render")
        ->type_name("DIR");
    app.add_option("--cameras", options.cameras,
                   "File to write with the cameras of the views: offsets, matrices, screen windows; as USD "
                   "(.usd, .usda, .usdc), cameras and render products of all frames in one file")
        ->type_name("FILE.json|FILE.csv|FILE.usd")
        ->check(camera_file());
    app.add_option_function<std::string>(
           "--up-axis", [&options](const std::string &axis) { options.up_axis = axis[0]; },
           "Axis of the world that points up in --cameras FILE.usd (default: as in --camera, else Y)")
        ->type_name("Y|Z")
        ->check(CLI::IsMember({"Y", "Z"}));
    app.add_option_function<std::string>(
           "--size", [&options](const std::string &text) { options.size = size_of(text); },
           "Size of the picture in pixels, without CENTER (default: the resolution of the stage's render "
           "settings)")
        ->type_name("WIDTHxHEIGHT");
    app.add_option(
           "--views", options.plan.views,
           fmt::format("Largest number of views from the rim of the lens (default: {})", options.plan.views))
        ->type_name("N")
        ->check(CLI::Range(0, 64));
    app.add_option(
           "--margin", options.plan.margin,
           fmt::format("Margin around the pixels that the centre view does not see, in pixels (default: {})",
                       options.plan.margin))
        ->type_name("PX")
        ->check(CLI::Range(0, 1024));
    app.add_option("--noise", options.plan.noise,
                   "Standard deviation of the noise of a tone-mapped pixel (default: measured)")
        ->type_name("SIGMA")
        ->check(number(at_least_0));
    app.add_option("--rays", options.rays,
                   "Total rays per pixel of the picture; prints how to divide them between views and two "
                   "renders through the lens (dof-finish)")
        ->type_name("N")
        ->check(CLI::Range(1, 1 << 20));
    add_parameters(app, lens_parameters(), options.lens);
    add_camera_options(app, options.camera);
    add_subpixels_option(app, options.supersample);
    add_depth_options(app, options.depth);
    add_parameters(app, depth_file_parameters(), options.depth.picture);
    add_examples(app, {{"Plan at most four views, and write a mask for each",
                        "ldi-plan center.exr -o plan.json --masks masks"},
                       {"Divide 320 rays per pixel between views and renders through the lens",
                        "ldi-plan center.exr -o plan.json --rays 320"},
                       {"Print where the cameras stand, for a spreadsheet or a script",
                        "ldi-plan center.exr -o plan.json --cameras cameras.csv"},
                       {"Write the cameras around a camera of USD, with all its keys",
                        "ldi-plan --camera shot.usd --size 1920x1080 --cameras views.usda"}});
}

} // namespace sparselens
