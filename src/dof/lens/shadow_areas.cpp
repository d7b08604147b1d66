#include "dof/lens/shadow_areas.h"

#include "base/grid.h"

#include <algorithm>
#include <utility>

namespace sparselens {

namespace {

constexpr std::size_t most_steps = 16;

} // namespace

ShadowAreas::ShadowAreas(const BlockedSamples &samples, const Links *links)
    : samples_(samples), links_(links), columns_(pieces_of(samples.columns, size)),
      depths_(std::size_t(columns_) * std::size_t(pieces_of(samples.rows, size))), made_(depths_.size()),
      steps_(depths_.size()), focus_(depths_.size()), block_depths_(samples.blocks.size()),
      to_edges_(samples.blocks.size()) {
    for (std::uint32_t b = 0; b < samples.blocks.size(); ++b) {
        Depths &depths = depths_[of(b)];
        depths.farthest = std::min(depths.farthest, samples.blocks[b].depth_min);
        depths.nearest = std::max(depths.nearest, samples.blocks[b].depth_max);
    }
}

const NearBounds *ShadowAreas::nearer_than(std::size_t area, float depth) const {
    std::call_once(made_[area], [&] {
        find_edges(area);
        steps_[area] = steps_of(area);
        focus_[area] = focus_of(area);
    });
    return steps_[area].nearer_than(depth);
}

// Returns the bits of the step that a depth lies in, and of all steps before it; 0 before the first step.
std::uint64_t ShadowAreas::BlockDepths::up_to(float depth) const {
    const float step = (depth - farthest) * in_px;
    if (!(step >= 0)) return 0;
    return step < 63 ? ~std::uint64_t{} >> (63 - int(step)) : ~std::uint64_t{};
}

void ShadowAreas::find_depths(std::uint32_t b) const {
    const SampleBlock &block = samples_.blocks[b];
    BlockDepths &depths = block_depths_[b];
    depths.farthest = block.depth_min;
    constexpr float least_range = 1e-3f; // pixels
    depths.in_px = 63 / std::max(block.depth_max - block.depth_min, least_range);
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
        const std::uint64_t up_to = depths.up_to(samples_.depth(i));
        depths.steps |= up_to & ~(up_to >> 1);
    }
}

std::vector<std::uint32_t> ShadowAreas::blocks_of(std::size_t area) const {
    std::vector<std::uint32_t> blocks;
    const int left = int(area) % columns_ * size, top = int(area) / columns_ * size;
    for (int row = top; row < std::min(top + size, samples_.rows); ++row)
        for (int column = left; column < std::min(left + size, samples_.columns); ++column)
            blocks.push_back(std::uint32_t(row * samples_.columns + column));
    return blocks;
}

void ShadowAreas::find_edges(std::size_t area) const {
    constexpr int pixels = BlockedSamples::size;
    for (const std::uint32_t b : blocks_of(area)) {
        const Imath::V2i first = Imath::V2i(int(b) % samples_.columns, int(b) / samples_.columns) * pixels;
        to_edges_[b] = coc_to_edges(links_, {first, first + Imath::V2i(pixels - 1)});
    }
}

CocRange ShadowAreas::focus_of(std::size_t area) const {
    constexpr float infinity = std::numeric_limits<float>::infinity(),
                    rounding = 0.01f; // pixels
    const std::span<const float> coc = samples_.hiding_coc();
    CocRange focus{infinity, -infinity};
    for (const std::uint32_t b : blocks_of(area))
        for (std::uint32_t i = samples_.blocks[b].begin; i < samples_.blocks[b].end; ++i) {
            focus.least = std::min(focus.least, samples_.depth(i) + coc[i] - to_edges_[b]);
            focus.most = std::max(focus.most, samples_.depth(i) + coc[i] + to_edges_[b]);
        }
    return {focus.least - rounding, focus.most + rounding};
}

NearSteps ShadowAreas::steps_of(std::size_t area) const {
    std::vector<NearBounds> samples;
    const std::span<const float> coc = samples_.hiding_coc();
    for (const std::uint32_t b : blocks_of(area)) {
        const SampleBlock &block = samples_.blocks[b];
        find_depths(b);
        for (std::uint32_t i = block.begin; i < block.end; ++i)
            samples.push_back({samples_.depth(i), samples_.x[i], samples_.x[i], samples_.y[i], samples_.y[i],
                               coc[i] - to_edges_[b], coc[i] + to_edges_[b]});
    }
    const std::size_t in_step = std::max(pieces_of(samples.size(), most_steps), std::size_t(1));
    return {std::move(samples), in_step};
}

} // namespace sparselens
