#include "lab/reporting/options.h"

#include "harness/tool.h"
#include "lab/tracing/trace_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace sparselens::lab {

void add_report_options(CLI::App &app, ReportOptions &options) {
    app.add_option(
           "SCENE", options.scenes,
           "Built-in scenes of dof-trace, or folders of ready-made views with a reference and a camera.json "
           "(default: fence grass lamps)")
        ->type_name("");
    app.add_option("-o,--output", options.folder,
                   "Folder for the report; what was measured there before is not measured again")
        ->required()
        ->type_name("DIR");
    app.add_flag("--quick", options.quick, "Use small pictures, few budgets and one variant of each method");
    app.add_option("--size", options.size,
                   "Size of the built-in scenes, in pixels (default: 640x360, with --quick 160x90)")
        ->type_name("WxH")
        ->check([](const std::string &text) {
            TraceOptions ignored;
            return read_size(text, ignored)
                       ? std::string()
                       : fmt::format("must be WIDTHxHEIGHT (e.g. 640x360), not '{}'", text);
        });
    app.add_option(
           "--reference", options.reference,
           "Rays per pixel of the reference of the built-in scenes (default: 4096, with --quick 1024)")
        ->type_name("SPP")
        ->check(CLI::Range(1, 1 << 20));
    app.add_option("--runs", options.runs,
                   "Number of runs whose median time is taken; long steps are run fewer times (default: 3, "
                   "with --quick 1)")
        ->type_name("N")
        ->check(CLI::Range(1, 1000));
    add_examples(
        app,
        {{"Measure small pictures of one scene, in under a minute", "dof-report fence --quick -o report"},
         {"Measure your own views, which have a reference and a camera.json", "dof-report shot -o report"}});
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
