#include "measure/image_error.h"
#include "measure/regions.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace sparselens {
namespace {

// Times all figures over the picture and three regions.
void figures(benchmark::State &state) {
    const int width = int(state.range(0)), height = width * 9 / 16;
    Image a(windows_of_size(width, height), rgba_channels()), b = a;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        a.values[i] = 0.5f + 0.5f * std::sin(float(i) * 0.37f);
        b.values[i] = 0.9f * a.values[i];
    }
    const auto bits = region_bits(a.plane(0), width, height);
    for (auto _ : state) benchmark::DoNotOptimize(image_error(a, b, bits, region_names.size()).data());
    state.SetItemsProcessed(state.iterations() * std::int64_t(a.windows.pixels()));
}
BENCHMARK(figures)->Arg(640)->Arg(1920)->Unit(benchmark::kMillisecond)->UseRealTime();

// CoC up to `range` pixels, a jump at every pixel: the time must not depend on it.
void regions(benchmark::State &state) {
    const int width = 640, height = 360;
    std::vector<float> c(std::size_t(width * height));
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = float(state.range(0)) * std::sin(float(i));
    for (auto _ : state) benchmark::DoNotOptimize(region_bits(c, width, height).data());
    state.SetItemsProcessed(state.iterations() * std::int64_t(c.size()));
}
BENCHMARK(regions)->Arg(4)->Arg(10000)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
} // namespace sparselens
