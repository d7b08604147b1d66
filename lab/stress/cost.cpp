// Counts how the cost of a gather grows: a device that gathers nothing counts the samples it is asked to look at.
#include "dof/device/tile_device.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/lens_gather.h"
#include "lab/stress/scenes.h"

#include <algorithm>
#include <array>
#include <vector>

namespace sparselens::lab {

namespace {

using namespace stress;

constexpr double tile_pixels = lens_tile_size * lens_tile_size;

// Sums over all tiles and the lens points of each: the samples in blocks that a lens point moves into the tile, and the
// blocks that it tests.
struct Looked {
    double samples = 0, blocks = 0;
    double points = 0; // lens points, summed over all tiles
    double for_each_pixel() const { return samples / (points * tile_pixels); }
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
Looked looked_at(int size, double coc, StressResult &result) {
    const ThinLens lens{.radius = 1, .focal_px = 1000, .focus = 5};
    const Pixel pixel{{depth_of(lens, coc), 0.3f}};
    const Ldi ldi = grey_ldi(window(size, size), [&](int, int) { return pixel; });
    Counter counter;
    Progress silent;
    lens_gather(ldi, lens, ldi.windows.data, {.device = &counter}, silent);
    result.pixels += double(ldi.windows.pixels());
    if (counter.looked.samples == 0) result.error = INFINITY;
    return counter.looked;
}

template <int Coc>
StressResult samples() {
    StressResult result;
    result.error += looked_at(512, Coc, result).for_each_pixel();
    return result;
}

StressResult blocks() {
    StressResult result;
    const Looked looked = looked_at(1024, 10, result);
    result.error += looked.blocks / looked.points;
    return result;
}

// The growth for four times the pixels, with a disc `wider` times as wide.
StressResult grown(double coc, double wider, double Looked::*count) {
    StressResult result;
    const Looked small = looked_at(512, coc, result), large = looked_at(1024, coc * wider, result);
    result.error += large.*count / small.*count;
    return result;
}
StressResult grown_picture() { return grown(10, 1, &Looked::blocks); }
StressResult grown_disc() { return grown(40, 2, &Looked::samples); }

// Samples within a tile of `cells` cells, one cell beside it on either side, or in a block of 8 that reaches into that.
constexpr double samples_for_each_pixel(int cells) { return (cells + 17.0) * (cells + 17.0) / tile_pixels; }

constexpr const char *whole_blocks = "a lens point moves into a tile what lies in it, one cell beside it, or "
                                     "in a block of 8 that reaches into these";
constexpr std::array cases{
    StressCase{"samples_coc_10", "samples looked at for each pixel and lens point, an opaque plane at CoC 10",
               samples_for_each_pixel(64), whole_blocks, samples<10>},
    StressCase{"samples_coc_30", "the same at CoC 30, three times as wide", samples_for_each_pixel(64),
               whole_blocks, samples<30>},
    StressCase{"cells_coc_40", "the same at CoC 40: cells of 4 x 4, two beside a tile",
               samples_for_each_pixel(16 + 4), whole_blocks, samples<40>},
    StressCase{"cells_coc_80", "the same at CoC 80: cells of 8 x 8, two beside a tile",
               samples_for_each_pixel(8 + 4), whole_blocks, samples<80>},
    StressCase{"blocks_coc_10", "blocks asked by each lens point, a plane at CoC 10 in 1024 x 1024 pixels",
               (64 + 2 * 10 + 17) * (64 + 2 * 10 + 17) / 64.0,
               "blocks of 8 x 8 within the CoC and a pixel of a tile, or that reach into that; 16384 are in "
               "the picture",
               blocks},
    StressCase{"grown_picture", "four times the pixels, CoC 10 as before: times the blocks asked", 4 * 1.25,
               "a tile at the border, of which a small picture has more, has fewer beside it", grown_picture},
    StressCase{"grown_disc", "four times the pixels, CoC 80 in place of 40: times the samples looked at", 4,
               "a wider disc costs no more: cells are as much larger", grown_disc},
};

} // namespace

std::span<const StressCase> cost_stress() { return cases; }

} // namespace sparselens::lab
