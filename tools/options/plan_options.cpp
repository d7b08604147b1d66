#include "options/plan_options.h"

#include "harness/examples.h"
#include "options/parameter_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace sparselens {

namespace {

CLI::Validator camera_file() {
    return CLI::Validator(
        [](std::string &name) {
            return name.ends_with(".json") || name.ends_with(".csv")
                       ? ""
                       : "must end in .json or .csv, not '" + name + "'";
        },
        "");
}

} // namespace

void add_plan_options(CLI::App &app, PlanCommand &options) {
    app.add_option("CENTER", options.centre, "Centre view, with colour and depth (EXR)")
        ->type_name("")
        ->required();
    app.add_option("-o,--output", options.output, "Plan to write; - for standard output")
        ->type_name("PLAN.json")
        ->required();
    app.add_option("--masks", options.masks,
                   "Folder for one mask per view, whose A is 1 in the pixels to render")
        ->type_name("DIR");
    app.add_option("--cameras", options.cameras,
                   "File for the cameras of the views: offsets, matrices, screen window, for any renderer")
        ->type_name("FILE.json|FILE.csv")
        ->check(camera_file());
    app.add_option(
           "--views", options.plan.views,
           fmt::format("Largest number of views from the rim of the lens (default: {})", options.plan.views))
        ->type_name("N")
        ->check(CLI::Range(0, 64));
    app.add_option("--margin", options.plan.margin,
                   fmt::format("Pixels added around what the centre view does not see (default: {})",
                               options.plan.margin))
        ->type_name("PX")
        ->check(CLI::Range(0, 1024));
    app.add_option("--noise", options.plan.noise,
                   "Standard deviation of the noise of a tone-mapped pixel (default: measured)")
        ->type_name("SIGMA")
        ->check(number(at_least_0));
    app.add_option(
           "--rays", options.rays,
           "Rays per pixel of the picture in all; say how to divide them between views and two renders "
           "through the lens, for dof-finish")
        ->type_name("N")
        ->check(CLI::Range(1, 1 << 20));
    add_parameters(app, lens_parameters(), options.lens);
    add_subpixels_option(app, options.supersample);
    add_depth_options(app, options.depth);
    add_parameters(app, depth_file_parameters(), options.depth.picture);
    add_examples(app, {{"Plan at most four views, and write a mask for each",
                        "ldi-plan center.exr -o plan.json --masks masks"},
                       {"Divide 320 rays per pixel between views and renders through the lens",
                        "ldi-plan center.exr -o plan.json --rays 320"},
                       {"Print where the cameras stand, for a spreadsheet or a script",
                        "ldi-plan center.exr -o plan.json --cameras cameras.csv"}});
}

} // namespace sparselens
