// Report rows for tests.
#pragma once

#include "lab/report/row.h"

#include <string>

namespace sparselens::lab {

inline ReportRow report_row(Role role, const std::string &renderer, double seconds, double rays,
                            double quality) {
    ReportRow row;
    row.scene = "fence";
    row.renderer = renderer;
    row.processor = role == Role::ray_tracing ? "" : "lens";
    row.budget = std::to_string(int(rays)) + " rays";
    row.role = role;
    row.rays = rays;
    row.seconds[std::size_t(Stage::render)] = 0.75 * seconds;
    row.seconds[std::size_t(Stage::process)] = 0.25 * seconds;
    row.runs = 3;
    row.errors.front().psnr_tonemapped = quality;
    return row;
}

// Gains 3 dB when the time doubles: 30 dB in a second, 4 rays per second.
inline std::vector<ReportRow> ray_tracing_rows() {
    return {report_row(Role::ray_tracing, "traced", 1, 4, 30),
            report_row(Role::ray_tracing, "traced", 4, 16, 36),
            report_row(Role::ray_tracing, "traced", 16, 64, 42)};
}

} // namespace sparselens::lab
