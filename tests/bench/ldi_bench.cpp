// Times operations on an LDI: ordering its samples, clustering, flattening.
#include "deep/cluster.h"
#include "deep/flatten.h"
#include "deep/tidy.h"
#include "support/ldi_samples.h"

#include <benchmark/benchmark.h>

namespace sparselens {
namespace {

// Points, out of order in half of the pixels; then with volumes that overlap.
void tidying(benchmark::State &state) {
    const Ldi messy =
        random_ldi({.width = 320, .height = 180, .volume_share = state.range(0) ? 0.3 : 0, .shuffled = true});
    for (auto _ : state) benchmark::DoNotOptimize(tidy(messy).z.data());
    state.SetItemsProcessed(state.iterations() * std::int64_t(messy.samples()));
}

void tidying_the_tidy(benchmark::State &state) {
    Ldi ldi = tidy(random_ldi({.width = 320, .height = 180}));
    for (auto _ : state) {
        ldi = tidy(std::move(ldi));
        benchmark::DoNotOptimize(ldi.z.data());
    }
    state.SetItemsProcessed(state.iterations() * std::int64_t(ldi.samples()));
}

// Into the fewest clusters that the tolerance allows; into at most `range` layers, which needs a search in each pixel.
void clustering(benchmark::State &state) {
    const Ldi ldi = tidy(random_ldi({.width = 320, .height = 180, .most_samples = 12, .opaque_share = 0.2}));
    const ClusterOptions options{.scale = 40, .tolerance = 0.25, .layers = int(state.range(0))};
    Progress silent;
    for (auto _ : state) benchmark::DoNotOptimize(cluster(ldi, options, silent).largest_error);
    state.SetItemsProcessed(state.iterations() * std::int64_t(ldi.samples()));
}

void flattening(benchmark::State &state) {
    const Ldi ldi = tidy(random_ldi({.width = 320, .height = 180}));
    for (auto _ : state) benchmark::DoNotOptimize(flatten(ldi).values.data());
    state.SetItemsProcessed(state.iterations() * std::int64_t(ldi.samples()));
}

BENCHMARK(tidying)->ArgName("volumes")->Arg(0)->Arg(1)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(tidying_the_tidy)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(clustering)->ArgName("layers")->Arg(0)->Arg(4)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(flattening)->UseRealTime()->Unit(benchmark::kMillisecond);

} // namespace
} // namespace sparselens
