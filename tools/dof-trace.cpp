// Renders a test scene: the centre view, views from the lens, deep pictures, and a distributed-ray-tracing
// reference.
#include "base/error.h"
#include "common/tool.h"
#include "common/trace_options.h"
#include "common/trace_outputs.h"
#include "io/plan_file.h"
#include "lens/lens_points.h"
#include "trace/deep.h"
#include "trace/render.h"
#include "trace/scenes.h"

#include <cstdio>

namespace sparselens {
namespace {

// Streams of random numbers: a picture's noise does not depend on what else is rendered. The reference has 0.
enum Stream : std::uint32_t { of_centre = 1, of_deep = 0x1000000, of_rim = 0x2000000, of_lens = 0x3000000 };

std::string numbered(const char *format, int number) {
    char name[32];
    std::snprintf(name, sizeof name, format, number);
    return name;
}

// The views of a plan, of each the pixels that it asks for.
void trace_plan(const TraceOptions &options, const Tracer &tracer, RenderSettings settings,
                TraceOutputs &outputs, const ToolContext &tool) {
    const PlanRequest plan = read_plan(options.plan);
    if (plan.display != settings.windows.display)
        throw Error(options.plan + ": was made for a picture of another size: see --size");
    for (std::size_t k = 0; k < plan.views.size(); ++k) {
        const RequestedView &view = plan.views[k];
        settings.windows.data = view.mask.data;
        outputs.add(numbered("view_%d.exr", int(k)), view.u, [&] {
            return render_view(tracer, settings, view.u, options.samples, of_rim + std::uint32_t(k),
                               *tool.progress, view.mask.set);
        });
    }
}

void trace(const TraceOptions &options, const ToolContext &tool) {
    const Scene scene = build_scene(options.scene);
    const Camera camera = camera_with_options(options.lens, scene.camera);
    const RenderSettings settings = render_settings(options, camera);
    const Tracer tracer(scene);
    TraceOutputs outputs(options.folder, camera, settings, options.type, tool);
    if (!options.plan.empty()) return trace_plan(options, tracer, settings, outputs, tool);
    RenderSettings to_average = settings;
    to_average.scattered = true;
    const auto add_view = [&](const RenderSettings &by, const std::string &name, const Imath::V2d &u,
                              std::uint32_t stream) {
        outputs.add(name, u,
                    [&] { return render_view(tracer, by, u, options.samples, stream, *tool.progress); });
    };
    const auto add_views = [&](const RenderSettings &by, const char *format,
                               const std::vector<Imath::V2d> &points, std::uint32_t stream) {
        for (std::size_t k = 0; k < points.size(); ++k)
            add_view(by, numbered(format, int(k)), points[k], stream + std::uint32_t(k));
    };
    const auto rim = rim_lens_points(options.views);

    add_view(settings, "center.exr", {0, 0}, of_centre);
    add_views(settings, "view_%d.exr", rim, of_rim);
    add_views(to_average, "lens_%04d.exr", spiral_lens_points(options.lens_views), of_lens);
    if (options.reference > 0)
        outputs.add("reference.exr", {0, 0},
                    [&] { return render_reference(tracer, settings, options.reference, *tool.progress); });
    for (const DeepRequest &deep : options.deep)
        outputs.add_deep(deep.peel ? "deep_peel.exr" : "deep_strata.exr", [&] {
            const auto render = deep.peel ? render_peeled : render_strata;
            return render(tracer, settings, deep.layers, options.samples, of_deep, *tool.progress);
        });
    outputs.write_summary(rim, options.samples, options.reference);
}

} // namespace
} // namespace sparselens

int main(int argc, char **argv) {
    using namespace sparselens;
    CLI::App app("Render a test scene: pinhole views from the lens, and the reference to compare with.",
                 "dof-trace");
    TraceOptions options;
    add_trace_options(app, options);
    return run_tool(app, argc, argv, [&](const ToolContext &tool) { trace(options, tool); });
}
