// Times the lens gather on a picture of many surfaces, at each quality.
#include "dof/lens/lens_gather.h"
#include "support/lens_ldi.h"

#include <benchmark/benchmark.h>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5}; // CoC up to 6 px

void lens_gathering(benchmark::State &state, Quality quality, bool opaque) {
    const Ldi ldi = random_surfaces(windows_of_size(320, 180), lens, opaque, 1);
    const LensGatherOptions options{.quality = quality};
    Progress silent;
    for (auto _ : state)
        benchmark::DoNotOptimize(lens_gather(ldi, lens, ldi.windows.data, options, silent).values.data());
    state.SetItemsProcessed(state.iterations() * std::int64_t(ldi.windows.pixels()));
}

void measure(const char *name, Quality quality, bool opaque) {
    benchmark::RegisterBenchmark(name, lens_gathering, quality, opaque)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
}

[[maybe_unused]] const bool registered = [] {
    measure("lens_gathering/opaque/draft", Quality::draft, true);
    measure("lens_gathering/opaque/normal", Quality::normal, true);
    measure("lens_gathering/opaque/final", Quality::final, true);
    measure("lens_gathering/half_partial/draft", Quality::draft, false);
    measure("lens_gathering/half_partial/normal", Quality::normal, false);
    measure("lens_gathering/half_partial/final", Quality::final, false);
    return true;
}();

} // namespace
} // namespace sparselens
