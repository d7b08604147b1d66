// The report in a terminal: a table of one scene's rows, and what they say.
#pragma once

#include "lab/report/row.h"

#include <span>
#include <string>

namespace sparselens::lab {

std::string summary_text(std::span<const ReportRow> rows);

} // namespace sparselens::lab
