#include "lab/reporting/options.h"

#include "lab/tracing/trace_options.h"

namespace sparselens::lab {

void add_report_options(CLI::App &app, ReportOptions &options) {
    app.add_option(
           "SCENE", options.scenes,
           "Built-in scenes of dof-trace, or folders of ready-made views with a reference and a camera.json "
           "(fence grass lamps)")
        ->type_name("");
    app.add_option("-o,--output", options.folder,
                   "Folder of the report; what is there already is not measured again")
        ->required()
        ->type_name("DIR");
    app.add_flag("--quick", options.quick, "Small pictures, few budgets, one variant of each method");
    app.add_option("--size", options.size, "Of built-in scenes, pixels (640x360; quick: 160x90)")
        ->type_name("WxH")
        ->check([](const std::string &text) {
            TraceOptions ignored;
            return read_size(text, ignored) ? "" : '\'' + text + "' is not WIDTHxHEIGHT";
        });
    app.add_option("--reference", options.reference,
                   "Rays a pixel of the reference of built-in scenes (4096; quick: 1024)")
        ->type_name("SPP")
        ->check(CLI::Range(1, 1 << 20));
    app.add_option("--runs", options.runs,
                   "Times are medians of so many runs; long steps are run fewer times (3; quick: 1)")
        ->type_name("N")
        ->check(CLI::Range(1, 1000));
}

Budgets budgets_of(const ReportOptions &options) {
    Budgets budgets;
    if (options.quick)
        budgets = {.size = "160x90",
                   .reference = 1024,
                   .samples = {4, 16},
                   .lens_views = {4, 64},
                   .rays = {4, 16, 64}};
    if (!options.size.empty()) budgets.size = options.size;
    if (options.reference > 0) budgets.reference = options.reference;
    return budgets;
}

int runs_of(const ReportOptions &options) { return options.runs > 0 ? options.runs : options.quick ? 1 : 3; }

Detail detail_of(const ReportOptions &options) { return options.quick ? Detail::one_of_each : Detail::all; }

} // namespace sparselens::lab
