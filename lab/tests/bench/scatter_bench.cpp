// A picture of many surfaces through the scatter.
#include "lab/methods/scatter.h"
#include "support/lens_ldi.h"

#include <benchmark/benchmark.h>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

Ldi picture(int width, int height) { return random_surfaces(windows_of_size(width, height), lens, false, 1); }

// The lens opened `range` times, in tenths: the largest CoC is 6 px at 1.
ThinLens opened(const benchmark::State &state) {
    ThinLens by = lens;
    by.radius *= double(state.range(0)) / 10;
    return by;
}

void scatter(benchmark::State &state) {
    const Ldi ldi = picture(64, 36);
    Progress progress;
    for (auto _ : state) benchmark::DoNotOptimize(scatter(ldi, opened(state), {}, progress));
    state.SetItemsProcessed(state.iterations() * std::int64_t(ldi.samples()));
}

BENCHMARK(scatter)->Arg(1)->Arg(10)->Arg(40)->UseRealTime()->Unit(benchmark::kMillisecond);

} // namespace
} // namespace sparselens
