#include "lab/reporting/traced_scene.h"

#include "lab/trace/scenes.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdio>

namespace sparselens::lab {

namespace {

constexpr int layer_count = 4;       // for depth peeling and strata
constexpr int fine = 2;              // size of fine views, relative to the picture
constexpr int lens_view_samples = 4; // per pixel: with fewer, sub-pixel shifts of the views cost much

std::vector<std::string> view_files(const std::string &folder, int rim) {
    std::vector<std::string> files{folder + "/center.exr"};
    for (int k = 0; k < rim; ++k) files.push_back(fmt::format("{}/view_{}.exr", folder, k));
    return files;
}

Rendered views_in(const std::string &folder, int rim, std::vector<std::size_t> steps) {
    Rendered views{.folder = folder, .picture = folder + "/center.exr", .steps = std::move(steps)};
    for (int k = 0; k < rim; ++k) views.rim.push_back({fmt::format("{}/view_{}.exr", folder, k), ""});
    views.views = 1 + rim;
    return views;
}

double pixels_of(const std::string &size) {
    int width = 0, height = 0;
    const char *end = size.data() + size.size();
    const auto [x, error] = std::from_chars(size.data(), end, width);
    if (x != end) std::from_chars(x + 1, end, height);
    return double(width) * height;
}

} // namespace

double TracedScene::focus_distance() const { return build_scene(name_).camera.focus_distance.value(); }

double TracedScene::weight(double rays) const { return 0.1 + rays * pixels_of(budgets_.size) / 1.5e7; }

StepCommand TracedScene::trace(const std::string &folder, int samples, int rim,
                               std::vector<std::string> more) const {
    StepCommand command{Stage::render,
                        {"dof-trace", name_, "--size", budgets_.size, "--spp", fmt::to_string(samples),
                         "--views", fmt::to_string(rim), "-o", folder}};
    command.words.insert(command.words.end(), more.begin(), more.end());
    return command;
}

// Uses its own random numbers: noise shared with the measured pictures would look like agreement.
Rendered TracedScene::reference(StepList &steps) const {
    const std::string folder = name_ + "/reference";
    Step step{
        .name = folder,
        .commands = {trace(folder, 1, 0, {"--reference", fmt::to_string(budgets_.reference), "--seed", "1"})},
        .outputs = {folder + "/reference.exr"},
        .timed = false,
        .weight = weight(budgets_.reference)};
    const std::size_t made = steps.add(std::move(step));
    return {.folder = folder, .picture = folder + "/reference.exr", .steps = {made}};
}

std::optional<Rendered> TracedScene::views(int rim, int samples, StepList &steps) const {
    return views(rim, samples, 1, steps);
}

// The budgets for which each pixel of a fine view gets a whole number of samples.
std::vector<int> TracedScene::fine_samples() const {
    std::vector<int> samples = budgets_.samples;
    std::erase_if(samples, [](int count) { return count % (fine * fine) != 0; });
    return samples;
}

std::optional<Rendered> TracedScene::fine_views(int rim, int samples, StepList &steps) const {
    return views(rim, samples, fine, steps);
}

Rendered TracedScene::views(int rim, int samples, int supersample, StepList &steps) const {
    const std::string folder =
        fmt::format("{}/{}-{}x{}", name_, supersample == 1 ? "views" : "fine", 1 + rim, samples);
    std::vector<std::string> more;
    if (supersample > 1) more = {"--supersample", fmt::to_string(supersample)};
    const std::size_t made = steps.add({.name = folder,
                                        .commands = {trace(folder, samples, rim, std::move(more))},
                                        .outputs = view_files(folder, rim),
                                        .weight = weight((1 + rim) * samples)});
    Rendered views = views_in(folder, rim, {made});
    views.rays = (1 + rim) * samples;
    views.supersample = supersample;
    return views;
}

std::optional<Rendered> TracedScene::layers(const std::string &kind, int samples, StepList &steps) const {
    const std::string folder = fmt::format("{}/{}-{}x{}", name_, kind, layer_count, samples);
    const std::string picture = folder + "/deep_" + kind + ".exr";
    const std::size_t made = steps.add(
        {.name = folder,
         .commands = {trace(folder, samples, 0, {"--deep", fmt::format("{}:{}", kind, layer_count)})},
         .outputs = {picture},
         .traced = folder,
         .uncounted = {"center.exr"},
         .weight = weight((1 + layer_count) * samples)});
    return Rendered{.folder = folder,
                    .picture = picture,
                    .steps = {made},
                    .rays = double(layer_count * samples)}; // each layer is shaded
}

std::optional<Rendered> TracedScene::accumulated(int views, StepList &steps) const {
    const std::string folder = fmt::format("{}/accumulated-{}", name_, views), scratch = folder + "/views";
    const std::string picture = folder + "/picture.exr";
    StepCommand average{Stage::process, {"dof-accumulate", "-o", picture}};
    for (int k = 0; k < views; ++k) average.words.push_back(fmt::format("{}/lens_{:04}.exr", scratch, k));
    const std::size_t made = steps.add(
        {.name = folder,
         .commands = {trace(scratch, lens_view_samples, 0, {"--lens-views", fmt::to_string(views)}), average},
         .outputs = {picture},
         .fresh = scratch,
         .scratch = true,
         .traced = scratch,
         .uncounted = {"center.exr"},
         .weight = weight(lens_view_samples * views) + 0.06 * views});
    return Rendered{.folder = folder,
                    .picture = picture,
                    .steps = {made},
                    .views = views,
                    .rays = double(lens_view_samples * views)};
}

std::optional<Rendered> TracedScene::distributed(int rays, StepList &steps) const {
    const std::string folder = fmt::format("{}/traced-{}", name_, rays), picture = folder + "/reference.exr";
    const std::size_t made =
        steps.add({.name = folder,
                   .commands = {trace(folder, 1, 0, {"--reference", fmt::to_string(rays)})},
                   .outputs = {picture},
                   .traced = folder,
                   .uncounted = {"center.exr"},
                   .weight = weight(rays)});
    return Rendered{.folder = folder, .picture = picture, .steps = {made}, .rays = double(rays)};
}

// A plan's requests are known only after it is made, so the views are named by a pattern and their rays counted later.
std::optional<Rendered> TracedScene::planned(int rim, int samples, StepList &steps) const {
    if (!can_plan_) return {};
    const Rendered centre = *views(0, samples, steps);
    const std::string folder = fmt::format("{}/planned-{}x{}", name_, 1 + rim, samples);
    const std::string plan = folder + "/plan.json", rendered = folder + "/views";
    const std::size_t planned =
        steps.add({.name = folder + "/plan",
                   .commands = {{Stage::plan,
                                 {"ldi-plan", centre.picture, "--views", fmt::to_string(rim), "-o", plan}}},
                   .inputs = centre.steps,
                   .outputs = {plan}});
    const std::size_t made =
        steps.add({.name = rendered,
                   .commands = {{Stage::render,
                                 {"dof-trace", name_, "--size", budgets_.size, "--spp",
                                  fmt::to_string(samples), "--plan", plan, "-o", rendered}}},
                   .inputs = {planned},
                   .outputs = {rendered + "/camera.json"},
                   .fresh = rendered,
                   .traced = rendered,
                   .uncounted = {"center.exr"},
                   .weight = weight(samples)});
    Rendered result = centre;
    result.folder = folder;
    result.rim = {{rendered + "/view_*.exr", ""}};
    result.steps.insert(result.steps.end(), {planned, made});
    result.planned_samples = samples;
    return result;
}

} // namespace sparselens::lab
