#include "dof/lens/block_finder.h"

#include <algorithm>

namespace sparselens {

BlockFinder::BlockFinder(const BlockedSamples &samples, const Aperture &aperture, double pixel_aspect)
    : samples_(samples),
      extent_(float(std::max(aperture.half_extent().x, aperture.half_extent().y * pixel_aspect))),
      row_reach_(std::size_t(samples.rows), 0) {
    for (std::size_t b = 0; b < samples.blocks.size(); ++b) {
        float &reach = row_reach_[b / std::size_t(samples.columns)];
        const SampleBlock &block = samples.blocks[b];
        const auto top = float(b / std::size_t(samples.columns) * BlockedSamples::size);
        const float moved =
            block.begin == block.end
                ? 0
                : std::max({0.0f, top - block.y_min, block.y_max - top - float(BlockedSamples::size)});
        reach = std::max(reach, reach_of(block) + moved);
    }
}

float BlockFinder::find(const Imath::V2i &origin, int size, float stretched,
                        std::vector<std::uint32_t> &found) const {
    found.clear();
    float largest = 0, largest_shown = 0;
    bool shows_opaque = false;
    const float left = float(origin.x - 1), top = float(origin.y - 1), right = float(origin.x + size + 1),
                bottom = float(origin.y + size + 1);
    for (int row = 0; row < samples_.rows; ++row) {
        const float reach = row_reach_[std::size_t(row)] * stretched + 1;
        if (float((row + 1) * BlockedSamples::size) + reach < top ||
            float(row * BlockedSamples::size) - reach > bottom)
            continue;
        for (int column = 0; column < samples_.columns; ++column) {
            const auto b = std::uint32_t(row * samples_.columns + column);
            const SampleBlock &block = samples_.blocks[b];
            const float r = reach_of(block) * stretched + 1;
            if (block.begin == block.end || block.x_max + r < left || block.x_min - r > right ||
                block.y_max + r < top || block.y_min - r > bottom)
                continue;
            found.push_back(b);
            largest = std::max(largest, largest_coc_of(block));
            largest_shown = std::max(largest_shown, block.coc_shown);
            shows_opaque = shows_opaque || block.shows_opaque;
        }
    }
    return shows_opaque ? largest : largest_shown;
}

float BlockFinder::reach_of(const SampleBlock &block) const {
    return block.begin == block.end ? 0 : largest_coc_of(block) * extent_;
}

} // namespace sparselens
