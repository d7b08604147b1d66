// A picture of many surfaces through the selective gather.
#include "dof/selective/selective.h"
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

void selective(benchmark::State &state) {
    const Ldi ldi = picture(320, 180);
    Progress progress;
    for (auto _ : state) benchmark::DoNotOptimize(selective_gather(ldi, opened(state), {}, progress));
    state.SetItemsProcessed(state.iterations() * std::int64_t(ldi.samples()));
}

BENCHMARK(selective)->Arg(1)->Arg(10)->Arg(40)->Arg(160)->Arg(20000)->UseRealTime()->Unit(
    benchmark::kMillisecond);

} // namespace
} // namespace sparselens
