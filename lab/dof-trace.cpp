// dof-trace: renders a test scene: the centre view, views over the lens, deep pictures, a reference by distributed ray
// tracing, and two such renders with few rays and independent noise.
#include "harness/tool.h"
#include "lab/trace/scenes.h"
#include "lab/tracing/trace_options.h"
#include "lab/tracing/trace_outputs.h"
#include "lab/tracing/traced_pictures.h"

#include <CLI/CLI.hpp>

namespace {

using namespace sparselens;
using namespace sparselens::lab;

void trace(const TraceOptions &options, const ToolContext &tool) {
    const Scene scene = build_scene(options.scene);
    const Camera camera = camera_with_options(options.lens, scene.camera);
    const RenderSettings settings = render_settings(options, camera, scene.camera_motion),
                         view = view_settings(options, camera, scene.camera_motion);
    const Tracer tracer(seen_after(scene, options.dolly));
    TraceOutputs outputs(options.folder, camera, settings, options.type, tool);
    const TraceJob job{options, tracer, settings, view, view_samples(options), outputs, *tool.progress};
    if (!options.plan.empty())
        return outputs.write_summary(trace_plan(job), options.samples, options.supersample, 0, 0);
    const std::vector<Imath::V2d> rim = trace_rim(job);
    trace_lens(job);
    trace_reference(job);
    trace_halves(job);
    trace_deep(job);
    outputs.write_summary(rim, options.samples, options.supersample, options.reference, options.halves / 2);
}

} // namespace

int main(int argc, char **argv) {
    CLI::App app("Renders a test scene: pinhole views from the lens, and the reference to compare with",
                 "dof-trace");
    TraceOptions options;
    add_trace_options(app, options);
    return run_tool(app, argc, argv, [&](const ToolContext &tool) { trace(options, tool); });
}
