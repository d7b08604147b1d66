#include "lab/report/row.h"

#include <numeric>

namespace sparselens::lab {

double total_seconds(const ReportRow &row) {
    return std::accumulate(row.seconds.begin(), row.seconds.end(), 0.0);
}

double quality(const ReportRow &row) { return row.errors.front().psnr_tonemapped; }

std::string scene_title(const ReportRow &row) {
    return row.size.empty() ? row.scene : row.scene + ", " + row.size;
}

std::string method_name(const ReportRow &row) {
    return row.processor.empty() ? row.renderer : row.renderer + ", " + row.processor;
}

} // namespace sparselens::lab
