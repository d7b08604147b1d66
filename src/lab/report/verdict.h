// What a scene's rows say: when sparse views seen through the lens are worth it, and when tracing the lens is.
//
// All from measured curves of distributed ray tracing (lab/report/curve.h): interpolated, never extrapolated.
#pragma once

#include "lab/report/curve.h"
#include "lab/report/row.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens::lab {

// Quality of distributed ray tracing over its seconds, and over its rays a pixel.
struct RayTracingCurves {
    Curve by_seconds, by_rays;
};
RayTracingCurves ray_tracing_curves(std::span<const ReportRow> rows);

// One row beside ray tracing.
struct RowVerdict {
    Reached seconds, rays; // what ray tracing takes for the row's error
    std::optional<double>
        equal_time; // dB the row is better in the same time; nothing outside of what was measured
};
RowVerdict row_verdict(const ReportRow &row, const RayTracingCurves &ray_tracing);

// Indices are into the scene's rows.
struct Beaten {
    std::size_t row, by; // `by` takes no longer and is no worse, and is better in one of the two
    std::size_t others;  // so many more do as well; `by` has the least error of them all
};

struct SceneVerdict {
    std::optional<std::size_t> best;         // the sparse row with the lens gather of least error
    Reached crossing_seconds, crossing_rays; // where ray tracing passes it
    std::vector<std::size_t> slower;         // sparse lens rows worse than ray tracing of the same time
    std::size_t below = 0;                   // how many sparse lens rows take less time than the crossing
    std::vector<Beaten> beaten;              // those of them that rows of other systems beat
};
SceneVerdict scene_verdict(std::span<const ReportRow> rows);

// "3.2", "< 3.2" or "> 3.2" in the unit given, "-" where nothing is known; `scale` divides the cost.
std::string reached_text(const Reached &reached, double scale = 1);

// The same as sentences for people, one a line: where each of the two is the better choice.
std::vector<std::string> verdict_sentences(std::span<const ReportRow> rows, const SceneVerdict &verdict);

} // namespace sparselens::lab
