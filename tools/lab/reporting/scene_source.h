// Where a report's pictures come from: a built-in scene, rendered by dof-trace, or a folder of ready-made views.
#pragma once

#include "lab/reporting/steps.h"
#include "options/lens_options.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sparselens::lab {

// How much a report measures.
struct Budgets {
    std::string size = "640x360";
    int reference = 4096;                              // rays a pixel
    int many_points = 4096;                            // lens points beyond which more change nothing
    std::vector<int> samples{1, 4, 16, 64};            // a pixel of a view
    std::vector<int> lens_views{4, 16, 64, 256, 1024}; // rendered over the lens
    std::vector<int> rays{4, 16, 64, 256, 1024};       // a pixel, distributed over the lens
};

struct PositionedView {
    std::string path;
    std::string position; // "X,Y" in scene units from the centre; empty: in the file's metadata
};

// Pictures to make depth of field from, or, of renderers that make it themselves, the picture.
struct Rendered {
    std::string folder{};  // for what is made of it, within the report's
    std::string picture{}; // the centre view, deep layers, or the final picture
    std::vector<PositionedView> rim{};
    std::vector<std::size_t> steps{}; // whose time it took
    double ready_seconds = 0;         // the time it took where no step made it
    int views = 1;
    double rays = 0;         // camera samples a pixel, all views together
    int planned_samples = 0; // above 0: rim views are partial, with so many samples in each pixel of coverage
};

class SceneSource {
public:
    virtual ~SceneSource() = default;

    virtual std::string name() const = 0;         // of the scene; fit for a file name
    virtual LensOptions lens() const = 0;         // what the pictures' metadata does not tell
    virtual std::vector<int> samples() const = 0; // budgets of views
    virtual std::vector<int> rays() const = 0;    // budgets of ray tracing over the lens
    virtual std::vector<int> lens_views() const = 0;

    // Each adds the steps it takes. Nothing where the source does not have it.
    virtual Rendered reference(StepList &steps) const = 0;
    virtual std::optional<Rendered> views(int rim, int samples, StepList &steps) const = 0;
    virtual std::optional<Rendered> planned(int rim, int samples, StepList &steps) const = 0;
    virtual std::optional<Rendered> layers(const std::string &kind, int samples, StepList &steps) const = 0;
    virtual std::optional<Rendered> accumulated(int views, StepList &steps) const = 0;
    virtual std::optional<Rendered> distributed(int rays, StepList &steps) const = 0;
};

// Whether the tools of that folder can render what a plan asks for: it takes one who plans and one who renders it.
bool can_plan(const std::string &tools);

// `scene`: the name of a built-in scene, or a folder with a camera.json, reference.exr, center.exr, view_K.exr and
// perhaps drt_N.exr (N rays a pixel over the lens) and further such folders of other sample counts. UsageError where
// it is neither.
std::unique_ptr<SceneSource> open_scene(const std::string &scene, const Budgets &budgets, bool with_plans);

} // namespace sparselens::lab
