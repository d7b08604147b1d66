#include "lab/reporting/systems.h"

#include "lab/report/numbers.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens::lab {

namespace {

using Words = std::vector<std::string>;

Words operator+(Words a, const Words &b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

constexpr int pull_frames = 16;
constexpr double pull_to = 1.1; // times the original focus distance

// The options as words for a tool.
Words words_of(const LensValues &lens) {
    Words words;
    const auto add = [&](const char *option, const std::optional<double> &value) {
        if (value) words = std::move(words) + Words{option, shortest(*value)};
    };
    add("--focal-length", lens.focal_length_mm);
    add("--sensor-width", lens.sensor_width_mm);
    add("--fstop", lens.fstop);
    add("--lens-radius", lens.lens_radius);
    add("--focus-distance", lens.focus_distance);
    add("--scene-unit", lens.scene_unit);
    return words;
}

// A file of layers, and the steps that made it.
struct Layers {
    std::string file;
    std::vector<std::size_t> steps;
};

class Chain {
public:
    Chain(const Rendered &rendered, const Words &lens, const Budgets &budgets, StepList &steps)
        : rendered_(rendered), lens_(lens), budgets_(budgets), steps_(steps) {}

    // Warps sparse views into one LDI; a single picture is used as it is.
    Layers warp() {
        Layers rendered{rendered_.picture, rendered_.steps};
        if (rendered_.rim.empty()) return rendered;
        Words views{"ldi-warp", rendered_.picture};
        for (const PositionedView &view : rendered_.rim)
            views = std::move(views) +
                    (view.position.empty() ? Words{view.path} : Words{"--view", view.position, view.path});
        return then(rendered, Stage::warp, "warped", views, lens_);
    }

    // Warps and clusters, for methods whose work grows with the layers.
    Layers layers(const std::string &name, const Words &cluster_words) {
        Layers warped = warp();
        if (rendered_.rim.empty()) return warped;
        return then(warped, Stage::cluster, name, {"ldi-cluster", warped.file}, cluster_words + lens_);
    }

    Layers gathered(const Layers &from, const std::string &name, const Words &words, double weight = 1.2) {
        return then(from, Stage::process, name, {"dof-gather", from.file}, words + size() + lens_, weight);
    }

    // This step counts in no row's time.
    std::string many_points() {
        const Layers from = warp();
        const Words words{"--method", "lens", "--lens-samples", fmt::to_string(budgets_.many_points)};
        const Layers made = then(from, Stage::process, "many-points", {"dof-gather", from.file},
                                 words + size() + lens_, 4, false);
        return made.file;
    }

    // A focus pull that starts at `focus`. Its step counts in no row's time either.
    std::vector<std::string> pull(const std::string &quality, double focus) {
        const Layers from = warp();
        const std::string name = rendered_.folder + "/pull-" + quality;
        const std::string keys = fmt::format("1:{},{}:{}", focus, pull_frames, pull_to * focus);
        Words words{"dof-gather", from.file, "--quality", quality, "-o", name + ".####.exr"};
        words = std::move(words) + size() + lens_;
        if (const auto own = std::ranges::find(words, "--focus-distance"); own != words.end())
            own[1] = keys;
        else
            words = std::move(words) + Words{"--focus-distance", keys};
        words = std::move(words) + Words{"--frames", fmt::format("1-{}", pull_frames)};
        Step step{.name = name,
                  .commands = {{Stage::process, words}},
                  .inputs = from.steps,
                  .timed = false,
                  .weight = 0.5 * pull_frames};
        for (int k = 1; k <= pull_frames; ++k) step.outputs.push_back(fmt::format("{}.{:04}.exr", name, k));
        const std::vector<std::string> frames = step.outputs;
        steps_.add(std::move(step));
        return frames;
    }

private:
    // Reduces the picture to the size of the reference, if the views are larger.
    Words size() const {
        return rendered_.supersample == 1 ? Words{}
                                          : Words{"--supersample", fmt::to_string(rendered_.supersample)};
    }

    Layers then(const Layers &from, Stage stage, const std::string &name, const Words &program_and_inputs,
                const Words &options, double weight = 1.2, bool timed = true) {
        const std::string file = rendered_.folder + '/' + name + ".exr";
        Step step{.name = rendered_.folder + '/' + name,
                  .commands = {{stage, program_and_inputs + options + Words{"-o", file}}},
                  .inputs = from.steps,
                  .outputs = {file},
                  .timed = timed,
                  .weight = weight};
        if (rendered_.steps.empty()) { // ready-made
            step.given = {rendered_.picture};
            for (const PositionedView &view : rendered_.rim) step.given.push_back(view.path);
        }
        Layers made{file, from.steps};
        made.steps.push_back(steps_.add(std::move(step)));
        return made;
    }

    const Rendered &rendered_;
    const Words &lens_;
    const Budgets &budgets_;
    StepList &steps_;
};

struct Processor {
    const char *name;
    bool quick; // also measured in a quick report
    bool lens;  // sees the layers through each lens point
    Layers (*process)(Chain &);
    const char *quality = ""; // of the lens gather
};

template <int K>
Layers selective(Chain &chain) {
    const std::string k = fmt::to_string(K);
    return chain.gathered(chain.layers("clustered-" + k, {"--layers", k}), "selective-" + k,
                          {"--method", "selective", "--layers", k});
}

Layers scatter(Chain &chain) {
    return chain.gathered(chain.layers("clustered", {}), "scatter", {"--method", "scatter"}, 4);
}

Layers lens(Chain &chain, const std::string &quality) {
    return chain.gathered(chain.warp(), "lens-" + quality, {"--method", "lens", "--quality", quality});
}

const Processor scattered{"scatter", true, false, scatter}, gathered{"gather", true, false, selective<8>},
    blended{"layered blend", true, false, selective<8>},
    selective_2{"selective K=2", false, false, selective<2>},
    selective_4{"selective K=4", false, false, selective<4>},
    selective_8{"selective K=8", true, false, selective<8>},
    lens_draft{"lens draft", false, true, [](Chain &c) { return lens(c, "draft"); }, "draft"},
    lens_normal{"lens normal", true, true, [](Chain &c) { return lens(c, "normal"); }, "normal"},
    lens_final{"lens final", false, true, [](Chain &c) { return lens(c, "final"); }, "final"};

struct System {
    const char *renderer;
    const char *unit; // of the budget, singular
    std::vector<int> (SceneSource::*budgets)() const;
    std::optional<Rendered> (*render)(const SceneSource &, int budget, StepList &);
    std::vector<const Processor *> processors; // empty: the renderer makes depth of field itself
    Role role_of_lens;  // of the rows of the lens gather, or of all rows without a processor
    bool pulls = false; // at the largest budget, also measures how steady the lens gather is
};

template <int Rim>
std::optional<Rendered> sparse(const SceneSource &scene, int samples, StepList &steps) {
    return scene.views(Rim, samples, steps);
}

template <int Rim>
std::optional<Rendered> planned(const SceneSource &scene, int samples, StepList &steps) {
    return scene.planned(Rim, samples, steps);
}

template <int Rim>
std::optional<Rendered> fine(const SceneSource &scene, int samples, StepList &steps) {
    return scene.fine_views(Rim, samples, steps);
}

template <int Rim>
std::optional<Rendered> denoised_fine(const SceneSource &scene, int samples, StepList &steps) {
    return scene.denoised_fine_views(Rim, samples, steps);
}

template <int Rim>
std::optional<Rendered> denoised_sparse(const SceneSource &scene, int samples, StepList &steps) {
    return scene.denoised_views(Rim, samples, steps);
}

std::optional<Rendered> strata(const SceneSource &scene, int samples, StepList &steps) {
    return scene.layers("strata", samples, steps);
}

std::optional<Rendered> peeled(const SceneSource &scene, int samples, StepList &steps) {
    return scene.layers("peel", samples, steps);
}

std::optional<Rendered> accumulated(const SceneSource &scene, int views, StepList &steps) {
    return scene.accumulated(views, steps);
}

std::optional<Rendered> distributed(const SceneSource &scene, int rays, StepList &steps) {
    return scene.distributed(rays, steps);
}

std::optional<Rendered> denoised(const SceneSource &scene, int rays, StepList &steps) {
    return scene.denoised(rays, steps);
}

const std::vector<System> &system_table() {
    using S = SceneSource;
    const std::vector<const Processor *> every{&selective_2, &selective_4, &selective_8,
                                               &lens_draft,  &lens_normal, &lens_final};
    static const std::vector<System> table{
        {"one view", "sample", &S::samples, sparse<0>, {&scattered, &gathered, &lens_normal}, Role::other},
        {"4 strata", "sample", &S::samples, strata, {&blended, &lens_normal}, Role::other},
        {"4 peeled layers", "sample", &S::samples, peeled, {&blended, &lens_normal}, Role::other},
        {"accumulated lens views", "view", &S::lens_views, accumulated, {}, Role::other},
        {"distributed ray tracing", "ray", &S::rays, distributed, {}, Role::ray_tracing},
        {"denoised ray tracing", "ray", &S::denoised_rays, denoised, {}, Role::other},
        {"centre + 4", "sample", &S::samples, sparse<4>, every, Role::sparse_lens, true},
        {"centre + 4", "sample", &S::fine_samples, fine<4>, {&lens_normal, &lens_final}, Role::sparse_lens},
        {"centre + 8", "sample", &S::samples, sparse<8>, every, Role::sparse_lens},
        {"centre + 4 denoised", "sample", &S::samples, denoised_sparse<4>, {&lens_normal}, Role::other},
        {"centre + 4 denoised", "sample", &S::fine_samples, denoised_fine<4>, {&lens_normal}, Role::other},
        {"centre + 4 planned",
         "sample",
         &S::samples,
         planned<4>,
         {&lens_draft, &lens_normal, &lens_final},
         Role::sparse_lens},
    };
    return table;
}

PlannedRow row_of(const SceneSource &scene, const System &system, int budget, const Rendered &rendered) {
    ReportRow row;
    row.scene = scene.name();
    row.renderer = system.renderer;
    if (rendered.supersample > 1) row.renderer += fmt::format(" at {}x", rendered.supersample);
    row.budget = fmt::format("{} {}{}", budget, system.unit, budget == 1 ? "" : "s");
    row.views = rendered.views;
    row.rays = rendered.rays;
    row.seconds[std::size_t(Stage::render)] = rendered.ready_seconds;
    PlannedRow planned_row{
        .row = std::move(row), .steps = rendered.steps, .picture = rendered.picture, .pull = rendered.pull};
    if (rendered.planned_samples > 0) {
        planned_row.partial_views = rendered.rim.front().path;
        planned_row.partial_samples = rendered.planned_samples;
    }
    return planned_row;
}

void add_rows(const SceneSource &scene, const System &system, int budget, const Rendered &rendered,
              const Budgets &budgets, Detail detail, StepList &steps, std::vector<PlannedRow> &rows) {
    if (system.processors.empty()) {
        rows.push_back(row_of(scene, system, budget, rendered));
        rows.back().row.role = system.role_of_lens;
        return;
    }
    const Words lens_words = words_of(scene.lens());
    Chain chain(rendered, lens_words, budgets, steps);
    for (const Processor *processor : system.processors) {
        if (detail == Detail::one_of_each && !processor->quick) continue;
        PlannedRow planned_row = row_of(scene, system, budget, rendered);
        planned_row.row.processor = processor->name;
        if (processor->lens) planned_row.row.role = system.role_of_lens;
        const Layers result = processor->process(chain);
        planned_row.picture = result.file;
        planned_row.steps = result.steps;
        planned_row.many_points = chain.many_points();
        if (system.pulls && processor->lens && budget == (scene.*system.budgets)().back())
            planned_row.pull = chain.pull(processor->quality, scene.focus_distance());
        rows.push_back(std::move(planned_row));
    }
}

} // namespace

ScenePlan plan_scene(const SceneSource &scene, const Budgets &budgets, Detail detail, StepList &steps) {
    ScenePlan plan{scene.name(), scene.lens(), scene.reference(steps), {}, {}};
    plan.centre = *scene.views(0, scene.samples().back(), steps);
    for (const System &system : system_table())
        for (const int budget : (scene.*system.budgets)())
            if (const auto rendered = system.render(scene, budget, steps))
                add_rows(scene, system, budget, *rendered, budgets, detail, steps, plan.rows);
    for (const Finished &other : scene.finished()) {
        const System made{other.renderer.c_str(), "", nullptr, nullptr, {}, Role::other};
        PlannedRow planned_row = row_of(scene, made, 0, other.rendered);
        planned_row.row.processor = other.processor;
        planned_row.row.budget = other.budget;
        plan.rows.push_back(std::move(planned_row));
    }
    return plan;
}

} // namespace sparselens::lab
