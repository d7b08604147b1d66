// The report's files: report.csv, plots/, index.html.
#pragma once

#include "common/tool.h"
#include "report/page.h"
#include "report/systems.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct MeasuredScene {
    ScenePlan plan;
    std::vector<ReportRow> rows;
};

// `facts`: lines about machine and command for the page. Plots need gnuplot; without it they are left out, with a
// warning.
void write_report(const std::string &folder, std::span<const MeasuredScene> scenes,
                  std::vector<std::string> facts, const ToolContext &tool);

// What the machine is and how busy it was: a line each.
std::vector<std::string> machine_facts(int threads);

} // namespace sparselens
