#include "dof/lens/block_finder.h"

#include <algorithm>

namespace sparselens {

namespace {

constexpr std::uint32_t blocks_in_run = 8; // as wide as a tile

// A box. It is reached by bounds [x_min, x_max] x [y_min, y_max] that come within `by` of it.
struct Box {
    float left, right, top, bottom;

    template <typename Bounds>
    bool is_reached(const Bounds &b, float by) const {
        return b.x_max + by >= left && b.x_min - by <= right && b.y_max + by >= top && b.y_min - by <= bottom;
    }
};

} // namespace

BlockFinder::BlockFinder(const BlockedSamples &samples, const Aperture &aperture, double pixel_aspect)
    : samples_(samples),
      extent_(float(std::max(aperture.half_extent().x, aperture.half_extent().y * pixel_aspect))) {
    const auto columns = std::uint32_t(samples.columns), all = std::uint32_t(samples.blocks.size());
    constexpr float most = std::numeric_limits<float>::max();
    for (std::uint32_t begin = 0, end = 0; begin < all; begin = end) {
        end = std::min(begin + blocks_in_run, begin / columns * columns + columns);
        Run run{begin, end, most, -most, most, -most, 0};
        for (std::uint32_t b = begin; b < end; ++b) {
            const SampleBlock &block = samples.blocks[b];
            if (block.begin == block.end) continue;
            run.x_min = std::min(run.x_min, block.x_min);
            run.x_max = std::max(run.x_max, block.x_max);
            run.y_min = std::min(run.y_min, block.y_min);
            run.y_max = std::max(run.y_max, block.y_max);
            run.reach = std::max(run.reach, reach_of(block));
        }
        if (run.x_min <= run.x_max) runs_.push_back(run);
    }
}

ReachingCocs BlockFinder::find(const Imath::V2i &origin, int size, float stretched,
                               std::vector<std::uint32_t> &found) const {
    found.clear();
    ReachingCocs cocs;
    float largest = 0, largest_shown = 0;
    bool shows_opaque = false;
    const Box box{float(origin.x - 1), float(origin.x + size + 1), float(origin.y - 1),
                  float(origin.y + size + 1)};
    for (const Run &run : runs_) {
        if (!box.is_reached(run, run.reach * stretched + 1)) continue;
        for (std::uint32_t b = run.begin; b < run.end; ++b) {
            const SampleBlock &block = samples_.blocks[b];
            if (block.begin == block.end || !box.is_reached(block, reach_of(block) * stretched + 1)) continue;
            found.push_back(b);
            largest = std::max(largest, largest_coc_of(block));
            largest_shown = std::max(largest_shown, block.coc_shown);
            cocs.least = std::min(cocs.least, block.coc_least);
            cocs.with_background = cocs.with_background || block.has_background;
            shows_opaque = shows_opaque || block.shows_opaque;
        }
    }
    cocs.largest = shows_opaque ? largest : largest_shown;
    return cocs;
}

float BlockFinder::reach_of(const SampleBlock &block) const {
    return block.begin == block.end ? 0 : largest_coc_of(block) * extent_;
}

} // namespace sparselens
