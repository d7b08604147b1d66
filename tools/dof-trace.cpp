// Renders a test scene: the centre view, views from the lens, deep pictures, and a distributed-ray-tracing
// reference.
#include "common/tool.h"
#include "common/trace_options.h"
#include "common/trace_outputs.h"
#include "lens/lens_points.h"
#include "trace/deep.h"
#include "trace/render.h"
#include "trace/scenes.h"

#include <algorithm>
#include <cstdio>

namespace sparselens {
namespace {

Scene scene_named(const std::string &name) {
    const auto table = scene_table();
    return std::find_if(table.begin(), table.end(),
                        [&](const SceneEntry &entry) { return entry.name == name; })
        ->build();
}

Windows windows_of(const TraceOptions &options) {
    Windows windows = windows_of_size(options.width, options.height);
    windows.data.min -= Imath::V2i(options.overscan);
    windows.data.max += Imath::V2i(options.overscan);
    return windows;
}

RenderSettings settings_of(const TraceOptions &options, const Camera &camera) {
    RenderSettings settings{windows_of(options), {}, options.light};
    settings.lens = resolve_lens(options.lens, camera, settings.windows);
    settings.lens.focal_px = options.width * *camera.focal_length_mm / *camera.sensor_width_mm;
    settings.lens.focus = *camera.focus_distance;
    return settings;
}

std::string numbered(const char *format, int number) {
    char name[32];
    std::snprintf(name, sizeof name, format, number);
    return name;
}

void trace(const TraceOptions &options, const ToolContext &tool) {
    const Scene scene = scene_named(options.scene);
    const Camera camera = camera_with_options(options.lens, scene.camera);
    const RenderSettings settings = settings_of(options, camera);
    const Tracer tracer(scene);
    TraceOutputs outputs(options.folder, camera, settings, options.type);
    std::uint32_t stream = 0; // of random numbers: the reference has the first
    const auto add_view = [&](const std::string &name, const Imath::V2d &u) {
        ++stream;
        outputs.add(name, u, [&] {
            return render_view(tracer, settings, u, options.samples, stream, *tool.progress);
        });
    };

    const auto rim = rim_lens_points(options.views), dense = spiral_lens_points(options.lens_views);
    add_view("center.exr", {0, 0});
    for (int k = 0; k < options.views; ++k) add_view(numbered("view_%d.exr", k), rim[std::size_t(k)]);
    for (int k = 0; k < options.lens_views; ++k)
        add_view(numbered("lens_%04d.exr", k), dense[std::size_t(k)]);
    if (options.reference > 0)
        outputs.add("reference.exr", {0, 0},
                    [&] { return render_reference(tracer, settings, options.reference, *tool.progress); });
    for (const DeepRequest &deep : options.deep) {
        const auto render = deep.kind == DeepRequest::Kind::peel ? render_peeled : render_strata;
        outputs.add_deep(deep.kind == DeepRequest::Kind::peel ? "deep_peel.exr" : "deep_strata.exr", [&] {
            return render(tracer, settings, deep.layers, options.samples, ++stream, *tool.progress);
        });
    }
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
