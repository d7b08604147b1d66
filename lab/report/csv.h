// report.csv: one line per row, after RFC 4180 (commas, quotes where needed), but with LF, which every reader accepts.
//
// Seconds are wall time, in total and by stage; rays are camera samples per pixel, all views together. Then follow the
// figures of measure/image_error.h over the whole picture and, with its name as a prefix, over each region. Values that
// were not measured or do not exist are empty; the PSNR of equal pictures is inf.
#pragma once

#include "lab/report/row.h"

#include <span>
#include <string>

namespace sparselens::lab {

// `rows` may hold several scenes, with rows of one scene together; each row is compared with the ray tracing of its
// scene.
std::string report_as_csv(std::span<const ReportRow> rows);

// The rows of each scene, in order.
std::vector<std::span<const ReportRow>> by_scene(std::span<const ReportRow> rows);

} // namespace sparselens::lab
