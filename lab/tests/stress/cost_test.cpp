// Counts how the cost of a gather grows: a device that gathers nothing counts the samples it is asked to look at.
#include "dof/device/tile_device.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/lens_gather.h"
#include "lab/tests/stress/stress.h"

#include <algorithm>

namespace sparselens::stress {

namespace {

constexpr double tile_pixels = lens_tile_size * lens_tile_size;

// Sums over all tiles and the lens points of each: the samples in blocks that a lens point moves into the tile, and the
// blocks that it tests.
struct Looked {
    double samples = 0, blocks = 0;
    double points = 0; // lens points, summed over all tiles
};

class Counter : public TileDevice {
public:
    void gather(const GatherScene &scene, std::span<const TileTask> tasks,
                const std::function<void(std::size_t, const TilePicture &)> &done) override {
        const std::vector<float> black(std::size_t(tile_pixels) * 4), known(std::size_t(tile_pixels), 1.0f);
        for (std::size_t n = 0; n < tasks.size(); ++n) {
            for (const LensSample &point : tasks[n].lens) count(scene.samples, tasks[n], point);
            done(n, {black.data(), known.data(), 1, black.size()});
        }
    }
    void gather(const SplatScene &, std::span<const SplatTask>,
                const std::function<void(std::size_t, const SplatPicture &)> &) override {}
    TileReport take_report() override { return {}; }

    Looked looked;

private:
    void count(const BlockedSamples &samples, const TileTask &task, const LensSample &point) {
        looked.points += 1;
        looked.blocks += double(task.samples.size());
        for (const std::uint32_t b : task.samples) {
            const SampleBlock &block = samples.blocks[b];
            if (lands(block.x_min, block.x_max, block, point.x, task.origin.x, task.size) &&
                lands(block.y_min, block.y_max, block, point.y, task.origin.y, task.size))
                looked.samples += block.end - block.begin;
        }
    }
    // Whether a block lands in the tile or the pixels next to it, along one axis.
    static bool lands(float least, float most, const SampleBlock &block, float moved, int origin, int size) {
        const auto [low, high] = std::minmax({block.coc_min * moved, block.coc_max * moved});
        return most + high >= float(origin - 1) && least + low <= float(origin + size + 1);
    }
};

// An opaque plane of that CoC that fills a square picture.
Looked looked_at(int size, double coc) {
    const ThinLens lens{.radius = 1, .focal_px = 1000, .focus = 5};
    const Pixel pixel{{depth_of(lens, coc), 0.3f}};
    const Ldi ldi = grey_ldi(size, size, [&](int, int) { return pixel; });
    Counter counter;
    Progress silent;
    lens_gather(ldi, lens, ldi.windows.data, {.device = &counter}, silent);
    EXPECT_GT(counter.looked.samples, 0);
    return counter.looked;
}

// For each pixel and lens point.
Result samples(double coc) {
    const Looked looked = looked_at(512, coc);
    return {looked.samples / (looked.points * tile_pixels)};
}
Result blocks() {
    const Looked looked = looked_at(1024, 10);
    return {looked.blocks / looked.points};
}

// A tile of `cells` cells, one cell beside it on either side, or in a block of 8 that reaches into that.
constexpr Limit whole_blocks(int cells) {
    return {(cells + 17.0) * (cells + 17.0) / tile_pixels,
            "a lens point moves into a tile what lies in it, one cell beside it, or in a block of 8 that "
            "reaches into these"};
}
constexpr Limit near_blocks{(64 + 2 * 10 + 17) * (64 + 2 * 10 + 17) / 64.0,
                            "blocks of 8 x 8 within the CoC and a pixel of a tile, or that reach into that; "
                            "16384 are in the picture"};
constexpr Limit border{4 * 1.25,
                       "a tile at the border, of which a small picture has more, has fewer beside it"};
constexpr Limit larger_cells{4, "a wider disc costs no more: cells are as much larger"};

constexpr Case cases[] = {
    {"samples_coc_10", "samples looked at for each pixel and lens point, an opaque plane at CoC 10",
     whole_blocks(64), [] { return samples(10); }},
    {"samples_coc_30", "the same at CoC 30, three times as wide", whole_blocks(64),
     [] { return samples(30); }},
    {"cells_coc_40", "the same at CoC 40: cells of 4 x 4, two beside a tile", whole_blocks(16 + 4),
     [] { return samples(40); }},
    {"cells_coc_80", "the same at CoC 80: cells of 8 x 8, two beside a tile", whole_blocks(8 + 4),
     [] { return samples(80); }},
    {"blocks_coc_10", "blocks asked by each lens point, a plane at CoC 10 in 1024 x 1024 pixels", near_blocks,
     blocks},
    {"grown_picture", "four times the pixels, CoC 10 as before: times the blocks asked", border,
     [] { return Result{looked_at(1024, 10).blocks / looked_at(512, 10).blocks}; }},
    {"grown_disc", "four times the pixels, CoC 80 in place of 40: times the samples looked at", larger_cells,
     [] { return Result{looked_at(1024, 80).samples / looked_at(512, 40).samples}; }},
};

} // namespace

INSTANTIATE_TEST_SUITE_P(cost, Stress, testing::ValuesIn(cases), name_of);

} // namespace sparselens::stress
