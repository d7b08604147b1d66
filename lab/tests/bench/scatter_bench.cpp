// Times the scatter on a picture of many surfaces.
#include "bench/opened_lens.h"
#include "lab/methods/scatter.h"

namespace sparselens {
namespace {

void scatter(benchmark::State &state) {
    const Ldi ldi = many_surfaces(64, 36);
    Progress progress;
    for (auto _ : state) benchmark::DoNotOptimize(scatter(ldi, opened(state), {}, progress));
    state.SetItemsProcessed(state.iterations() * std::int64_t(ldi.samples()));
}

BENCHMARK(scatter)->Arg(1)->Arg(10)->Arg(40)->UseRealTime()->Unit(benchmark::kMillisecond);

} // namespace
} // namespace sparselens
