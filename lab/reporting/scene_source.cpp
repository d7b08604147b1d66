#include "lab/reporting/scene_source.h"

#include "base/error.h"
#include "lab/reporting/ready_scene.h"
#include "lab/reporting/traced_scene.h"
#include "lab/trace/scenes.h"
#include "lab/tracing/trace_options.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>

namespace sparselens::lab {

bool can_plan(const std::string &tools) {
    CLI::App trace;
    TraceOptions ignored;
    add_trace_options(trace, ignored);
    return std::filesystem::exists(std::filesystem::path(tools) / "ldi-plan") &&
           trace.get_option_no_throw("--plan");
}

std::unique_ptr<SceneSource> open_scene(const std::string &scene, const Budgets &budgets, bool with_plans) {
    if (std::ranges::any_of(scene_table(), [&](const SceneEntry &entry) { return scene == entry.name; }))
        return std::make_unique<TracedScene>(scene, budgets, with_plans);
    if (std::filesystem::exists(std::filesystem::path(scene) / "camera.json"))
        return std::make_unique<ReadyScene>(scene);
    throw UsageError(scene + ": neither a built-in scene nor a folder with a camera.json");
}

} // namespace sparselens::lab
