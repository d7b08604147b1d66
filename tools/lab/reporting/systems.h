// Every kind of system a report compares: what is rendered, and what makes depth of field of it.
#pragma once

#include "lab/reporting/scene_source.h"

#include <optional>
#include <string>
#include <vector>

namespace sparselens::lab {

// A row before it is measured.
struct PlannedRow {
    ReportRow row;                  // seconds of what was given, rays, names
    std::vector<std::size_t> steps; // whose times are the row's
    std::string picture{};          // the result
    std::string partial_views{}; // a pattern: views whose rays are known only once they are there; else empty
    int partial_samples = 0;     // a pixel of theirs
    std::string many_points{};   // the same layers seen through many lens points; empty: not of layers
};

struct ScenePlan {
    std::string name;
    LensOptions lens;
    Rendered reference;
    Rendered centre; // its depths tell the regions of the picture apart
    std::vector<PlannedRow> rows;
};

// Which of the processors are measured: a quick report leaves out variants of the same.
enum class Detail { all, one_of_each };

// Adds the steps that the scene's rows take.
ScenePlan plan_scene(const SceneSource &scene, const Budgets &budgets, Detail detail, StepList &steps);

} // namespace sparselens::lab
