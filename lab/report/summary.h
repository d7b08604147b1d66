// The report in a terminal: a table of the rows of one scene, and the verdict.
#pragma once

#include "lab/report/row.h"

#include <span>
#include <string>

namespace sparselens::lab {

std::string summary_text(std::span<const ReportRow> rows);

} // namespace sparselens::lab
