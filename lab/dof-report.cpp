// dof-report: measures error and run time of every kind of system that makes depth of field.
#include "base/error.h"
#include "harness/tool.h"
#include "lab/report/summary.h"
#include "lab/reporting/measurement.h"
#include "lab/reporting/options.h"
#include "lab/reporting/outputs.h"
#include "lab/reporting/process.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <set>

namespace {

using namespace sparselens;
using namespace sparselens::lab;
namespace fs = std::filesystem;

// The other tools are in the folder of this one.
std::string folder_of_tools() { return fs::read_symlink("/proc/self/exe").parent_path().string(); }

RunOptions run_options(const ReportOptions &options, const ToolContext &tool) {
    return {.tools = folder_of_tools(),
            .folder = fs::absolute(options.folder).string(),
            .threads = tool.threads,
            .runs = runs_of(options),
            .max_memory = tool.max_memory};
}

void print(const std::string &text) {
    if (std::fputs(text.c_str(), stdout) == EOF || std::fflush(stdout) != 0)
        throw Error("standard output: cannot write");
}

std::vector<MeasuredScene> plan_scenes(const ReportOptions &options, const RunOptions &run, StepList &steps) {
    const std::vector<std::string> usual{"fence", "grass", "lamps"};
    const Budgets budgets = budgets_of(options);
    std::vector<MeasuredScene> scenes;
    std::set<std::string> names;
    for (const std::string &scene : options.scenes.empty() ? usual : options.scenes) {
        const auto source = open_scene(scene, budgets, can_plan(run.tools));
        if (!names.insert(source->name()).second)
            throw UsageError(scene + ": another scene is called " + source->name() + " too");
        scenes.push_back({plan_scene(*source, budgets, detail_of(options), steps), {}});
    }
    return scenes;
}

void report(const ReportOptions &options, const std::string &command, const ToolContext &tool) {
    const RunOptions run = run_options(options, tool);
    const std::string load_before = load_fact();
    StepList steps;
    std::vector<MeasuredScene> scenes = plan_scenes(options, run, steps);
    const std::vector<StepTimes> times = run_steps(steps.steps(), run, tool);
    const std::vector<std::string> facts{machine_fact(tool.threads), command,
                                         "load before the first step: " + load_before +
                                             ", after the last: " + load_fact()};
    print(facts[0] + '\n' + facts[1] + '\n' + facts[2] + "\n\n");
    for (MeasuredScene &scene : scenes) {
        scene.rows = measure_rows(scene.plan, times, run.folder, tool);
        print(summary_text(scene.rows) + '\n');
    }
    write_report(run.folder, scenes, facts, tool);
}

} // namespace

int main(int argc, char **argv) {
    CLI::App app("Measures the error and the run time of every kind of system that makes depth of field, on "
                 "your scene",
                 "dof-report");
    ReportOptions options;
    add_report_options(app, options);
    const std::string command = command_line({argv, argv + argc});
    return run_tool(app, argc, argv, [&](const ToolContext &tool) { report(options, command, tool); });
}
