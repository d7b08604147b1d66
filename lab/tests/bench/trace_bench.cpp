// Times the tracer in packets beside its slow reference, and a camera ray with all its shading.
#include "base/numbers.h"
#include "lab/tests/trace/brute_force.h"
#include "lab/tests/trace/small_scenes.h"

#include <benchmark/benchmark.h>

namespace sparselens::lab {
namespace {

// Rays of a row of pixels, with 16 lens points each, as similar to each other as those of a reference.
std::vector<Ray> rays_of_a_row() {
    const RenderSettings settings = settings_of_size(640, 360);
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < 640 * 16; ++i) {
        const Imath::V2d u(unit_interval(mix_bits(i, 1)) - 0.5, unit_interval(mix_bits(i, 2)) - 0.5);
        rays.push_back(lens_ray(settings, u, {double(i / 16) + 0.5, 200.5}));
    }
    return rays;
}

void trace_packets(benchmark::State &state) {
    const Tracer tracer(build_scene("grass"));
    const auto rays = rays_of_a_row();
    std::vector<Hit> hits(rays.size());
    for (auto _ : state) tracer.nearest(rays, hits);
    state.SetItemsProcessed(std::int64_t(state.iterations()) * std::int64_t(rays.size()));
}
BENCHMARK(trace_packets);

void trace_by_brute_force(benchmark::State &state) {
    const Scene scene = build_scene("grass");
    const auto rays = rays_of_a_row();
    for (auto _ : state)
        for (std::size_t i = 0; i < rays.size(); i += 16) benchmark::DoNotOptimize(all_hits(scene, rays[i]));
    state.SetItemsProcessed(std::int64_t(state.iterations()) * std::int64_t(rays.size() / 16));
}
BENCHMARK(trace_by_brute_force);

void render_reference_rows(benchmark::State &state, const char *scene) {
    RenderSettings settings = settings_of_size(640, 360);
    settings.windows.data = {{0, 200}, {639, 203}};
    const Tracer tracer(build_scene(scene));
    Progress silent;
    for (auto _ : state) benchmark::DoNotOptimize(render_reference(tracer, settings, 16, silent));
    state.SetItemsProcessed(std::int64_t(state.iterations()) * 640 * 4 * 16);
}
BENCHMARK_CAPTURE(render_reference_rows, fence, "fence")->UseRealTime();
BENCHMARK_CAPTURE(render_reference_rows, grass, "grass")->UseRealTime();
BENCHMARK_CAPTURE(render_reference_rows, mist, "mist")->UseRealTime();

} // namespace
} // namespace sparselens::lab
