#include "measure/image_error.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace sparselens {
namespace {

void ssim(benchmark::State &state) {
    const int width = int(state.range(0)), height = width * 9 / 16;
    std::vector<float> a(std::size_t(width) * std::size_t(height)), b(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        a[i] = 0.5f + 0.5f * std::sin(float(i) * 0.37f);
        b[i] = 0.9f * a[i];
    }
    for (auto _ : state) benchmark::DoNotOptimize(ssim_map(a, b, width, height).values.data());
    state.SetItemsProcessed(state.iterations() * std::int64_t(a.size())); // pixels
}
BENCHMARK(ssim)->Arg(640)->Arg(1920)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
} // namespace sparselens
