#include "lab/methods/accumulate.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace sparselens {
namespace {

// Adds one RGBA view.
void add_view(benchmark::State &state) {
    const int width = int(state.range(0)), height = width * 9 / 16;
    Image view(windows_of_size(width, height), rgba_channels());
    for (std::size_t i = 0; i < view.values.size(); ++i)
        view.values[i] = 0.5f + 0.5f * std::sin(float(i) * 0.37f);
    Accumulation sum = start_accumulation(view.windows, view.channels);
    for (auto _ : state) accumulate(sum, view, {3.3, -1.7}, "view");
    state.SetItemsProcessed(state.iterations() * std::int64_t(view.windows.pixels()));
}
BENCHMARK(add_view)->Arg(640)->Arg(1920)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
} // namespace sparselens
