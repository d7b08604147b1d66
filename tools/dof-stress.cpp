// dof-stress: stiff and extreme cases, each with its error, one line a case.
#include "base/error.h"
#include "harness/tool.h"
#include "lab/stress/stress_case.h"

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
    char text[32];
    std::snprintf(text, sizeof text, "%.1e", result.energy);
    return text;
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
        std::printf("| %s | %s | %.1e | %.1e | %s | %s | %s |\n", c.name, c.claim, result.error, c.bound,
                    energy_text(result).c_str(), c.reason, pass ? "pass" : "FAIL");
    else
        std::printf("%-28s error %.1e of %.1e  energy %8s  time %5.1fx  %s%s\n",
                    (std::string(family.name) + "/" + c.name).c_str(), result.error, c.bound,
                    energy_text(result).c_str(), times_plain(result),
                    thrown.empty() ? "" : (thrown + "  ").c_str(), pass ? "pass" : "FAIL");
    std::fflush(stdout);
}

void stress(const Options &options) {
    Tally tally;
    for (const StressFamily &family : stress_families()) {
        if (options.markdown)
            std::printf("\n## %s\n\n| case | what is measured | error | bound | energy | why this bound | "
                        "|\n|---|---|---|---|---|---|---|\n",
                        family.name);
        for (const StressCase &c : family.cases)
            if (options.one_case.empty() || options.one_case == c.name ||
                options.one_case == std::string(family.name) + "/" + c.name)
                print_case(options, family, c, tally);
    }
    if (tally.run == 0) throw UsageError("--case: there is no case '" + options.one_case + "'");
    if (tally.failed > 0)
        throw Error(std::to_string(tally.failed) + " of " + std::to_string(tally.run) + " cases fail");
}

} // namespace

int main(int argc, char **argv) {
    CLI::App app("Stiff and extreme cases of depth of field, each with its error", "dof-stress");
    Options options;
    app.add_option("--case", options.one_case, "This case alone (its name, or FAMILY/NAME)")
        ->type_name("NAME");
    app.add_flag("--markdown", options.markdown, "Tables for docs/stress.md, with the reason for each bound");
    return run_tool(
        app, argc, argv, [&](const ToolContext &) { stress(options); }, Reads::nothing);
}
