// One measurement of a report: the scene, the method of making depth of field, its budget, its time, and its distance
// from the reference.
#pragma once

#include "measure/image_error.h"
#include "measure/regions.h"
#include "measure/temporal_error.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace sparselens::lab {

// The stages that the time of a picture is divided into.
enum class Stage : std::size_t { render, plan, warp, cluster, process };
inline constexpr std::array<const char *, 5> stage_names{"render", "plan", "warp", "cluster", "process"};

// The role of a row in the comparison.
enum class Role {
    other,
    sparse_lens, // sparse views seen through each point of the lens: the method of sparselens
    ray_tracing  // distributed over the lens: the method that others are compared with
};

// The two causes of error, each as the tone-mapped PSNR (dB) of one picture against another.
struct ErrorCauses {
    double sampling; // the picture against the same layers seen through many lens points
    double layers;   // the latter against the reference: what the layers lack
};

struct ReportRow {
    std::string scene, renderer, processor;
    std::string budget; // of the renderer: "16 samples"
    std::string size{}; // of the picture, pixels: "640x360"
    Role role = Role::other;
    int views = 1;
    double rays = 0;                 // camera samples per pixel, all views together
    std::array<double, 5> seconds{}; // wall time of each Stage
    int runs = 0;                    // the times are medians of so many runs; 0: they came with the pictures
    double peak_mb = 0;              // memory of the largest process, MiB
    std::array<ErrorFigures, 1 + region_names.size()> errors{}; // the whole picture, then each region
    std::optional<ErrorCauses> causes;
    std::optional<Steadiness> pull;  // of a focus pull to 1.1 times its distance, in 16 frames
    std::string picture, difference; // PNG files, relative to the folder of the report
    std::string worst{}; // another PNG: the worst 8 x 8 pixels with surroundings, beside the reference
};

double total_seconds(const ReportRow &row);
double quality(const ReportRow &row);          // tone-mapped PSNR of the whole picture, dB
std::string scene_title(const ReportRow &row); // with the picture's size, on which times depend
std::string method_name(const ReportRow &row); // renderer and processor: one line in the plots

} // namespace sparselens::lab
