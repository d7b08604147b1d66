// The systems that a report compares: a renderer, and a processor that makes depth of field from its pictures.
#pragma once

#include "lab/reporting/scene_source.h"

#include <optional>
#include <string>
#include <vector>

namespace sparselens::lab {

// A row before it is measured.
struct PlannedRow {
    ReportRow row;                  // names, rays, and the seconds of ready-made pictures
    std::vector<std::size_t> steps; // the steps whose times the row adds up
    std::string picture{};          // the result
    std::string partial_views{}; // a pattern of views whose rays are known only after rendering; else empty
    int partial_samples = 0;     // per pixel of these
    std::string many_points{};   // the same layers seen through many lens points; empty without layers
    std::vector<std::string> pull{}; // frames of a focus pull over the same layers; empty: none is made
};

struct ScenePlan {
    std::string name;
    LensValues lens;
    Rendered reference;
    Rendered centre; // its depths define the picture's regions
    std::vector<PlannedRow> rows;
};

// The processors to measure: a quick report leaves out variants.
enum class Detail { all, one_of_each };

// Adds the steps that the rows of the scene need.
ScenePlan plan_scene(const SceneSource &scene, const Budgets &budgets, Detail detail, StepList &steps);

} // namespace sparselens::lab
