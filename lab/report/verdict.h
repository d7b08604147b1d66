// The verdict on a scene's rows: where sparse views seen through the lens are better, and where ray tracing is.
//
// It follows from measured curves of distributed ray tracing (lab/report/curve.h), which are never extrapolated.
#pragma once

#include "lab/report/curve.h"
#include "lab/report/row.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens::lab {

// The quality of distributed ray tracing over its seconds, and over its rays per pixel.
struct RayTracingCurves {
    Curve by_seconds, by_rays;
};
RayTracingCurves ray_tracing_curves(std::span<const ReportRow> rows);

// One row compared with ray tracing.
struct RowVerdict {
    Reached seconds, rays; // costs at which ray tracing reaches the row's error
    // dB by which the row is better than ray tracing in the same time; empty outside the measured range
    std::optional<double> equal_time;
};
RowVerdict row_verdict(const ReportRow &row, const RayTracingCurves &ray_tracing);

// All numbers are indices of the rows of the scene.
struct Beaten {
    std::size_t row, by; // `by` is no slower and no worse, and better in one of the two
    std::size_t others;  // number of other such rows; `by` has the least error of all
};

struct SceneVerdict {
    std::optional<std::size_t> best;         // the sparse lens-gather row of least error
    Reached crossing_seconds, crossing_rays; // where ray tracing reaches its quality
    std::vector<std::size_t> slower;         // sparse lens rows worse than ray tracing of the same time
    std::size_t below = 0;      // the number of sparse lens rows that are faster than the crossing
    std::vector<Beaten> beaten; // those of them that rows of other systems beat
};
SceneVerdict scene_verdict(std::span<const ReportRow> rows);

// "3.2", "< 3.2" or "> 3.2"; "-" if nothing is known. The cost is divided by `scale`.
std::string reached_text(const Reached &reached, double scale = 1);

// The verdict in sentences, one per line: where each of the two is the better choice.
std::vector<std::string> verdict_sentences(std::span<const ReportRow> rows, const SceneVerdict &verdict);

} // namespace sparselens::lab
