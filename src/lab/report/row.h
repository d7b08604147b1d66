// One measurement of a report: a scene, a way of making depth of field, what it was allowed, what it took, how far
// from the reference it came.
#pragma once

#include "measure/image_error.h"
#include "measure/regions.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace sparselens::lab {

// What a picture's time goes into.
enum class Stage : std::size_t { render, plan, warp, cluster, process };
inline constexpr std::array<const char *, 5> stage_names{"render", "plan", "warp", "cluster", "process"};

// Where a row stands in the comparison.
enum class Role {
    other,
    sparse_lens, // sparse views seen through each point of the lens: what sparselens is for
    ray_tracing  // distributed over the lens: what all else is measured against
};

// Errors of two kinds, each the tone-mapped PSNR (dB) of one picture against another.
struct ErrorCauses {
    double sampling; // the row's picture against the same layers seen through many lens points
    double layers;   // that picture against the reference: what the layers lack
};

struct ReportRow {
    std::string scene, renderer, processor;
    std::string budget; // of the renderer: "16 samples"
    Role role = Role::other;
    int views = 1;
    double rays = 0;                 // camera samples a pixel, all views together
    std::array<double, 5> seconds{}; // wall time of each Stage
    int runs = 0;                    // medians of so many; 0: times were given with the pictures
    double peak_mb = 0;              // memory of the largest process, MiB
    std::array<ErrorFigures, 1 + region_names.size()> errors{}; // the whole picture, then each region
    std::optional<ErrorCauses> causes;
    std::string picture, difference; // PNG, relative to the report's folder
};

double total_seconds(const ReportRow &row);
double quality(const ReportRow &row);          // tone-mapped PSNR of the whole picture, dB
std::string method_name(const ReportRow &row); // renderer and processor: a line in plots

} // namespace sparselens::lab
