// Times the weights of one PSF: the closed form for each pixel, and row by row.
#include "lens/psf.h"

#include <benchmark/benchmark.h>

#include <array>

namespace sparselens {
namespace {

constexpr int size = PsfRows::max_size;
const Imath::Box2i box({0, 0}, {size - 1, size - 1});

Psf psf_of(const benchmark::State &state) { return {{31.3, 32.8}, double(state.range(0)) / 10, 1}; }

void psf_closed_form(benchmark::State &state) {
    const Psf psf = psf_of(state);
    const int reach = int(psf.radius) + 2;
    for (auto _ : state)
        for (int y = 32 - reach; y <= 32 + reach; ++y)
            for (int x = 31 - reach; x <= 31 + reach; ++x) benchmark::DoNotOptimize(psf_weight(psf, x, y));
}

void psf_rows(benchmark::State &state) {
    std::array<double, size> weights;
    for (auto _ : state) {
        const PsfRows rows(psf_of(state), box);
        for (int y = rows.begin_row(); y < rows.end_row(); ++y) {
            benchmark::DoNotOptimize(rows.row(y, weights.data()));
            benchmark::ClobberMemory();
        }
    }
}

// Radius in tenths of a pixel.
BENCHMARK(psf_closed_form)->Arg(3)->Arg(15)->Arg(50)->Arg(250);
BENCHMARK(psf_rows)->Arg(3)->Arg(15)->Arg(50)->Arg(250);

} // namespace
} // namespace sparselens
