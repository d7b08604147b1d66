// The command line of dof-report.
#pragma once

#include "harness/commands/cli.h"
#include "lab/reporting/runner.h"
#include "lab/reporting/systems.h"

#include <string>
#include <vector>

namespace sparselens::lab {

struct ReportOptions {
    std::vector<std::string> scenes;
    std::string folder;
    bool quick = false;
    std::string size;  // empty: set by --quick
    int reference = 0; // 0: set by --quick
    int runs = 0;      // 0: set by --quick
};

void add_report_options(CLI::App &app, ReportOptions &options);

Budgets budgets_of(const ReportOptions &options);
int runs_of(const ReportOptions &options);
Detail detail_of(const ReportOptions &options);

} // namespace sparselens::lab
