// Times the selective gather on a picture of many surfaces.
#include "bench/opened_lens.h"
#include "dof/selective/selective.h"

namespace sparselens {
namespace {

void selective(benchmark::State &state) {
    const Ldi ldi = many_surfaces(320, 180);
    Progress progress;
    for (auto _ : state) benchmark::DoNotOptimize(selective_gather(ldi, opened(state), {}, progress));
    state.SetItemsProcessed(state.iterations() * std::int64_t(ldi.samples()));
}

BENCHMARK(selective)->Arg(1)->Arg(10)->Arg(40)->Arg(160)->Arg(20000)->UseRealTime()->Unit(
    benchmark::kMillisecond);

} // namespace
} // namespace sparselens
