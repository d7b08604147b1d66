// Times the reduction of 1280x720 sub-pixels to 640x360 and to 320x180 pixels.
#include "base/subpixels.h"

#include <benchmark/benchmark.h>

namespace sparselens {
namespace {

void mean_of_blocks(benchmark::State &state) {
    Image fine(windows_of_size(1280, 720), rgba_channels());
    for (std::size_t i = 0; i < fine.values.size(); ++i) fine.values[i] = float(i % 1021);
    const Subpixels by{int(state.range(0)), {PixelFilter::Shape(state.range(1)), 1.5}};
    const Imath::Box2i box = reduced(fine.windows.data, by.across);
    for (auto _ : state) benchmark::DoNotOptimize(mean_of_subpixels(fine, by, box).values.data());
    state.SetItemsProcessed(state.iterations() * std::int64_t(fine.windows.pixels()));
}

BENCHMARK(mean_of_blocks)
    ->ArgNames({"across", "filter"})
    ->Args({2, 0})
    ->Args({2, 1})
    ->Args({4, 1})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace sparselens
