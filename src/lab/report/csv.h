// report.csv: a line a row, after RFC 4180 (commas, CRLF left out as every reader takes LF, quotes where needed).
//
// Seconds are wall time, total and by stage; rays are camera samples a pixel of all views together; then every
// figure of measure/image_error.h over the whole picture and, prefixed by its name, over each region. What was not
// measured, or has no value, is empty; the PSNR of equal pictures is inf.
#pragma once

#include "lab/report/row.h"

#include <span>
#include <string>

namespace sparselens::lab {

// `rows` of any number of scenes, those of one scene together: each is compared with its scene's ray tracing.
std::string report_as_csv(std::span<const ReportRow> rows);

// The rows of one scene after the other.
std::vector<std::span<const ReportRow>> by_scene(std::span<const ReportRow> rows);

} // namespace sparselens::lab
