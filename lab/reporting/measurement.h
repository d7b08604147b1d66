// Makes the rows of the report from the files that the steps wrote.
#pragma once

#include "harness/tool.h"
#include "lab/report/page.h"
#include "lab/reporting/systems.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens::lab {

// Measures every row against the reference of the scene; `times` are one per step. Writes PNG files of the picture of
// each row, of its difference and of its worst place, tone-mapped like the figures, the difference multiplied by 8.
std::vector<ReportRow> measure_rows(const ScenePlan &plan, std::span<const StepTimes> times,
                                    const std::string &folder, const ToolContext &tool);

// The pictures for the page: the reference, the best of the sparse views, then the fastest and best of each method.
std::vector<PagePicture> page_pictures(const ScenePlan &plan, std::span<const ReportRow> rows,
                                       const std::string &folder);

// The worst part of each row's picture beside the same part of the reference.
std::vector<PagePicture> worst_places(std::span<const ReportRow> rows, const std::string &folder);

} // namespace sparselens::lab
