// The source of the pictures of a report: a built-in scene, rendered by dof-trace, or a folder of ready-made views.
#pragma once

#include "lab/reporting/steps.h"
#include "view/resolve_lens.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sparselens::lab {

// How much a report measures.
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

// The pictures from which depth of field is made, or the final picture of renderers that make it themselves.
struct Rendered {
    std::string folder{};  // for what is made of it, within that of the report
    std::string picture{}; // the centre view, deep layers, or the final picture
    std::vector<PositionedView> rim{};
    std::vector<std::size_t> steps{}; // the steps that made it
    double ready_seconds = 0;         // its render time where no step made it
    int views = 1;
    double rays = 0;         // camera samples per pixel, all views together
    int planned_samples = 0; // above 0: rim views are partial, with so many samples in each covered pixel
    int supersample = 1;     // views are so many times as wide as the picture
    std::vector<std::string>
        pull{}; // frames of a pull of focus that were rendered the same way; may be empty
};

// A picture that another way made.
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
    } // of denoised(): some ready-made scenes have those

    // Each adds the steps that it needs, and returns nothing where the source does not provide such pictures.
    virtual Rendered reference(StepList &steps) const = 0;
    virtual std::optional<Rendered> views(int rim, int samples, StepList &steps) const = 0;
    virtual std::optional<Rendered> planned(int rim, int samples, StepList &steps) const = 0;
    virtual std::optional<Rendered> layers(const std::string &kind, int samples, StepList &steps) const = 0;
    virtual std::optional<Rendered> accumulated(int views, StepList &steps) const = 0;
    virtual std::optional<Rendered> distributed(int rays, StepList &steps) const = 0;

    // Views of more pixels with as many rays: `samples` are those of a pixel of the picture.
    virtual std::vector<int> fine_samples() const { return {}; }
    virtual std::optional<Rendered> fine_views(int, int, StepList &) const { return {}; }
    virtual std::optional<Rendered> denoised_fine_views(int, int, StepList &) const { return {}; }
    virtual std::vector<Finished> finished() const { return {}; }

    // What a denoiser made of the views, and of the rays over the lens; the seconds are those of both.
    virtual std::optional<Rendered> denoised_views(int, int, StepList &) const { return {}; }
    virtual std::optional<Rendered> denoised(int, StepList &) const { return {}; }
};

// Whether the tools of that folder can make a plan and render it.
bool can_plan(const std::string &tools);

// `scene` is the name of a built-in scene, or a folder with camera.json, reference.exr, center.exr, view_K.exr and
// optionally drt_N.exr (N rays per pixel over the lens), what a denoiser made of any of these (center.denoised.exr, ...; lab/denoise),
// pictures that camera.json lists as "others", frames of a pull of focus (drt_N.pull.0001.exr, ...) and
// further such folders for other sample counts, or with finer views. Throws UsageError where it is neither.
std::unique_ptr<SceneSource> open_scene(const std::string &scene, const Budgets &budgets, bool with_plans);

} // namespace sparselens::lab
