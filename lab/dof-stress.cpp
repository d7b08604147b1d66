// dof-stress: runs extreme and numerically stiff cases and prints the error of each, one line per case.
#include "base/error.h"
#include "harness/tool.h"
#include "lab/stress/stress_case.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <string>

namespace {

using namespace sparselens;
using namespace sparselens::lab;

struct Options {
    std::string one_case;
    bool markdown = false;
};

struct Tally {
    int run = 0, failed = 0;
};

std::string energy_text(const StressResult &result) {
    if (std::isnan(result.energy)) return "-";
    return fmt::format("{:.1e}", result.energy);
}

StressResult run_guarded(const StressCase &c, std::string &thrown) {
    try {
        return c.run();
    } catch (const std::exception &error) {
        thrown = error.what();
        return {.error = INFINITY};
    }
}

void print_case(const Options &options, const StressFamily &family, const StressCase &c, Tally &tally) {
    std::string thrown;
    const StressResult result = run_guarded(c, thrown);
    const bool pass = holds(c, result);
    ++tally.run;
    tally.failed += pass ? 0 : 1;
    if (options.markdown)
        fmt::print("| {} | {} | {:.1e} | {:.1e} | {} | {} | {} |\n", c.name, c.claim, result.error, c.bound,
                   energy_text(result), c.reason, pass ? "pass" : "FAIL");
    else
        fmt::print("{:<28} error {:.1e} of {:.1e}  energy {:>8}  time {:5.1f}x  {}{}\n",
                   fmt::format("{}/{}", family.name, c.name), result.error, c.bound, energy_text(result),
                   times_plain(result), thrown.empty() ? "" : thrown + "  ", pass ? "pass" : "FAIL");
    std::fflush(stdout);
}

void stress(const Options &options) {
    Tally tally;
    for (const StressFamily &family : stress_families()) {
        if (options.markdown)
            fmt::print("\n## {}\n\n| case | what is measured | error | bound | energy | why this bound | "
                       "|\n|---|---|---|---|---|---|---|\n",
                       family.name);
        for (const StressCase &c : family.cases)
            if (options.one_case.empty() || options.one_case == c.name ||
                options.one_case == fmt::format("{}/{}", family.name, c.name))
                print_case(options, family, c, tally);
    }
    if (tally.run == 0)
        throw UsageError(
            fmt::format("--case: no case is called '{}'; without --case all are listed", options.one_case));
    if (tally.failed > 0) throw Error(fmt::format("{} of {} cases fail", tally.failed, tally.run));
}

} // namespace

int main(int argc, char **argv) {
    CLI::App app("Runs stiff and extreme cases of depth of field and prints the error of each", "dof-stress");
    Options options;
    app.add_option("--case", options.one_case, "Run only the case of this name, or of this FAMILY/NAME")
        ->type_name("NAME");
    app.add_flag("--markdown", options.markdown,
                 "Print the tables of lab/results/stress.md, with the reason for each bound");
    add_examples(app, {{"Run one case", "dof-stress --case z_nan"}});
    return run_tool(
        app, argc, argv, [&](const ToolContext &) { stress(options); }, Reads::nothing);
}
