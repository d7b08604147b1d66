// The files of the report: report.csv, plots/, index.html.
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

// `facts` are lines about the machine and the command for the page. Plots need gnuplot; without it they are left out,
// with a warning.
void write_report(const std::string &folder, std::span<const MeasuredScene> scenes,
                  std::vector<std::string> facts, const ToolContext &tool);

std::string machine_fact(int threads); // the machine and the date
std::string load_fact();               // mean number of running processes in the last minute

} // namespace sparselens::lab
