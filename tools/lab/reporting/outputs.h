// The report's files: report.csv, plots/, index.html.
#pragma once

#include "harness/tool.h"
#include "lab/report/page.h"
#include "lab/reporting/systems.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens::lab {

struct MeasuredScene {
    ScenePlan plan;
    std::vector<ReportRow> rows;
};

// `facts`: lines about machine and command for the page. Plots need gnuplot; without it they are left out, with a
// warning.
void write_report(const std::string &folder, std::span<const MeasuredScene> scenes,
                  std::vector<std::string> facts, const ToolContext &tool);

std::string machine_fact(int threads); // what is measured on, and when
std::string load_fact(); // how busy it is: the mean number of running processes of the last minute

} // namespace sparselens::lab
