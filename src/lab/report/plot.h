// The plots of a report as a gnuplot script: error against seconds and against rays, both axes logarithmic, a line
// a method.
//
// Error is the root mean square of tone-mapped differences, 10^(-psnr_tonemapped / 20); the right axis says it in
// dB. The script writes NAME-seconds and NAME-rays, .svg and .png, into the folder it is run in.
#pragma once

#include "lab/report/row.h"

#include <span>
#include <string>

namespace sparselens::lab {

// `rows` of one scene; `name`: of the files, without what a shell or gnuplot would stumble over.
std::string plot_script(std::span<const ReportRow> rows, const std::string &name);

} // namespace sparselens::lab
