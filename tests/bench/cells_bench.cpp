// Times tiles far out of focus: making the small scene that they are gathered from, making pixels from cells, and a
// whole gather, which does both; at CoCs with cells of 4 x 4 and 8 x 8 pixels, and a little below.
#include "dof/lens/cells.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/lens_gather.h"
#include "support/lens_ldi.h"

#include <benchmark/benchmark.h>

#include <vector>

namespace sparselens {
namespace {

void cells_interpolated(benchmark::State &state) {
    const TileCells of = cells_of_tile({64, 128}, int(state.range(0)));
    std::vector<float> values(std::size_t(4 * lens_tile_size * lens_tile_size)),
        known(values.size() / 4, 1.0f);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i * 7919 % 101) / 101;
    const TilePicture cells{values.data(), known.data(), 1, values.size()};
    for (auto _ : state) benchmark::DoNotOptimize(interpolated(cells, of).values.data());
    state.SetItemsProcessed(state.iterations() * lens_tile_size * lens_tile_size);
}
BENCHMARK(cells_interpolated)->Arg(4)->Arg(8)->Unit(benchmark::kMicrosecond);

constexpr ThinLens lens{.radius = 1, .focal_px = 1000, .focus = 5}; // CoCs up to 200 px

// A floor with CoCs from `coc` to 10 pixels more.
Ldi floor_from(double coc) {
    return make_ldi(windows_of_size(512, 256), {{"R"}, {"G"}, {"B"}, {"A"}}, [&](int x, int y) {
        const auto light = float(0.2 + 0.2 * random_unit(x, y, 1));
        return std::vector<Sample>{{depth_of(lens, coc + 10 * y / 255.0), {light, light / 2, light / 4, 1}}};
    });
}

void scene_of_cells(benchmark::State &state) {
    const Ldi ldi = floor_from(64);
    const GatherScene scene = prepare(ldi, lens, ldi.windows.data, {});
    for (auto _ : state) benchmark::DoNotOptimize(coarse_scene(scene, int(state.range(0))).samples.x.data());
    state.SetItemsProcessed(state.iterations() * std::int64_t(ldi.windows.pixels()));
}
BENCHMARK(scene_of_cells)->Arg(4)->Arg(8)->UseRealTime()->Unit(benchmark::kMillisecond);

void gather_in_cells(benchmark::State &state) {
    const Ldi ldi = floor_from(double(state.range(0)));
    Progress silent;
    for (auto _ : state)
        benchmark::DoNotOptimize(lens_gather(ldi, lens, ldi.windows.data, {}, silent).values.data());
    state.SetItemsProcessed(state.iterations() * std::int64_t(ldi.windows.pixels()));
}
BENCHMARK(gather_in_cells)->Arg(24)->Arg(32)->Arg(64)->UseRealTime()->Unit(benchmark::kMillisecond);

} // namespace
} // namespace sparselens
