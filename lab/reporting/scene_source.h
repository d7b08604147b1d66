// The source of a report's pictures: a built-in scene, rendered by dof-trace, or a folder of ready-made views.
#pragma once

#include "lab/reporting/steps.h"
#include "view/resolve_lens.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sparselens::lab {

// The budgets that a report measures.
struct Budgets {
    std::string size = "640x360";
    int reference = 4096;                              // rays per pixel
    int many_points = 4096;                            // so many lens points that more change nothing
    std::vector<int> samples{1, 4, 16, 64};            // per pixel of a view
    std::vector<int> lens_views{4, 16, 64, 256, 1024}; // rendered over the lens
    std::vector<int> rays{4, 16, 64, 256, 1024};       // per pixel, distributed over the lens
};

struct PositionedView {
    std::string path;
    std::string position; // "X,Y" in scene units from the centre; empty: in the file's metadata
};

// Pictures to make depth of field from, or the final picture of a renderer that makes it itself.
struct Rendered {
    std::string folder{};  // for files made from it, inside the report's folder
    std::string picture{}; // the centre view, deep layers, or the final picture
    std::vector<PositionedView> rim{};
    std::vector<std::size_t> steps{}; // the steps that made it
    double ready_seconds = 0;         // its render time, if no step made it
    int views = 1;
    double rays = 0;         // camera samples per pixel, all views together
    int planned_samples = 0; // above 0: rim views are partial, with this many samples in each covered pixel
    int supersample = 1;     // the width of views over the width of the picture
    std::vector<std::string> pull{}; // frames of a focus pull, rendered the same way; may be empty
};

// A picture made by another program.
struct Finished {
    std::string renderer, processor, budget;
    Rendered rendered;
};

class SceneSource {
public:
    virtual ~SceneSource() = default;

    virtual std::string name() const = 0;         // the name of the scene, usable as a file name
    virtual LensValues lens() const = 0;          // what the metadata of the pictures lacks
    virtual double focus_distance() const = 0;    // scene units
    virtual std::vector<int> samples() const = 0; // budgets of views
    virtual std::vector<int> rays() const = 0;    // budgets of ray tracing over the lens
    virtual std::vector<int> lens_views() const = 0;
    virtual std::vector<int> denoised_rays() const {
        return {};
    } // budgets of denoised(), which some ready-made scenes have

    // Each adds the steps that it needs, and returns nothing if the source does not provide such pictures.
    virtual Rendered reference(StepList &steps) const = 0;
    virtual std::optional<Rendered> views(int rim, int samples, StepList &steps) const = 0;
    virtual std::optional<Rendered> planned(int rim, int samples, StepList &steps) const = 0;
    virtual std::optional<Rendered> layers(const std::string &kind, int samples, StepList &steps) const = 0;
    virtual std::optional<Rendered> accumulated(int views, StepList &steps) const = 0;
    virtual std::optional<Rendered> distributed(int rays, StepList &steps) const = 0;

    // Views with more pixels and the same number of rays: `samples` counts per pixel of the picture.
    virtual std::vector<int> fine_samples() const { return {}; }
    virtual std::optional<Rendered> fine_views(int, int, StepList &) const { return {}; }
    virtual std::optional<Rendered> denoised_fine_views(int, int, StepList &) const { return {}; }
    virtual std::vector<Finished> finished() const { return {}; }

    // Denoised views, and denoised rays over the lens; the seconds include rendering and denoising.
    virtual std::optional<Rendered> denoised_views(int, int, StepList &) const { return {}; }
    virtual std::optional<Rendered> denoised(int, StepList &) const { return {}; }
};

// Whether the tools in that folder can make a plan and render it.
bool can_plan(const std::string &tools);

// `scene` is the name of a built-in scene, or a folder with camera.json, reference.exr, center.exr, view_K.exr and
// optionally drt_N.exr (N rays per pixel over the lens), denoised versions of these (center.denoised.exr, ...;
// lab/denoise), pictures that camera.json lists as "others", frames of a focus pull (drt_N.pull.0001.exr, ...) and
// further such folders for other sample counts, or with finer views. Throws UsageError if it is neither.
std::unique_ptr<SceneSource> open_scene(const std::string &scene, const Budgets &budgets, bool with_plans);

} // namespace sparselens::lab
