#include "options/plan_options.h"

namespace sparselens {

void add_plan_options(CLI::App &app, PlanCommand &options) {
    app.add_option("CENTER", options.centre, "the centre view: colour and depth")
        ->type_name("CENTER.exr")
        ->required();
    app.add_option("-o,--output", options.output, "plan to write, - for standard output")
        ->type_name("PLAN.json")
        ->required();
    app.add_option("--masks", options.masks, "folder for a mask a view: A is 1 in the pixels asked for")
        ->type_name("DIR");
    app.add_option("--views", options.plan.views, "rim views, at most")
        ->type_name("N")
        ->check(CLI::Range(0, 64))
        ->capture_default_str();
    app.add_option("--margin", options.plan.margin, "pixels around what the centre view does not see")
        ->type_name("PX")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    app.add_option("--noise", options.plan.noise,
                   "standard deviation of a pixel's noise, tone-mapped (default: measured)")
        ->type_name("SIGMA")
        ->check(number("a standard deviation", {.zero_allowed = true}));
    add_lens_options(app, options.lens);
    add_depth_options(app, options.depth);
}

} // namespace sparselens
