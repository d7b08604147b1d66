// The plots of a report as a gnuplot script: error against seconds and against rays, with logarithmic axes and one line
// per method.
//
// The error is the root mean square of tone-mapped differences, 10^(-psnr_tonemapped / 20); the right axis shows it in
// dB. The script writes NAME-seconds and NAME-rays, as .svg and .png, into the folder where it is run.
#pragma once

#include "lab/report/row.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens::lab {

// The rows of the most important ways, six at most. Ways that only the literature has are left out.
std::vector<ReportRow> rows_in_use(std::span<const ReportRow> rows);

// `rows`: of one scene. `name`: of the files, without characters that are special to a shell or gnuplot.
std::string plot_script(std::span<const ReportRow> rows, const std::string &name);

} // namespace sparselens::lab
