// Times warping views to an LDI, with each of the options that change the amount of work.
#include "support/views.h"
#include "warp/warp.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace sparselens {
namespace {

// Stripes before a back plane, noisy, in five views of 640 x 360.
std::vector<View> views() {
    TwoPlanes scene;
    scene.focal_px = 640;
    scene.noise = 0.1f;
    scene.front_covers = [](double x, double) { return std::fmod(x + 10'000, 100) < 40; };
    return five_views(scene, windows_of_size(640, 360), 0.06);
}

void warping(benchmark::State &state, WarpOptions options) {
    const std::vector<View> five = views();
    options.focal_px = 640;
    options.radius = 0.06;
    Progress silent;
    for (auto _ : state) benchmark::DoNotOptimize(warp(five, options, silent).z.data());
    state.SetItemsProcessed(state.iterations() * std::int64_t(5 * five[0].z.size()));
}

void measure(const char *name, const WarpOptions &options) {
    benchmark::RegisterBenchmark(name, warping, options)->UseRealTime()->Unit(benchmark::kMillisecond);
}

[[maybe_unused]] const bool registered = [] {
    measure("warping/average", {});
    measure("warping/average_in_focus_at_2", {.focus = 2.0});
    measure("warping/average_without_splitting", {.split_silhouettes = false});
    measure("warping/average_without_photo_consistency", {.test_photo_consistency = false});
    measure("warping/keep", {.merge = Merge::keep});
    return true;
}();

} // namespace
} // namespace sparselens
