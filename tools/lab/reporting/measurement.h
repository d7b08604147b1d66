// From the files that the steps left to the rows of the report.
#pragma once

#include "harness/tool.h"
#include "lab/report/page.h"
#include "lab/reporting/systems.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens::lab {

// Measures every row against the scene's reference; `times`: one a step. Writes a PNG of each row's picture and
// of its difference into NAME/ beside the picture, as tone-mapped as the figures are, the difference eightfold.
std::vector<ReportRow> measure_rows(const ScenePlan &plan, std::span<const StepTimes> times,
                                    const std::string &folder, const ToolContext &tool);

// For the page's viewer: the reference, the best of the sparse views, then each method's fastest and best.
std::vector<PagePicture> page_pictures(const ScenePlan &plan, std::span<const ReportRow> rows,
                                       const std::string &folder);

} // namespace sparselens::lab
