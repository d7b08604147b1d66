#include "dof/lens/block_footprints.h"

#include "base/parallel.h"

#include <utility>

namespace sparselens {

namespace {

constexpr int in_area = 8; // blocks an area is wide and high

// Returns the ranges of depth of the footprints that join several depths: ascending, without overlaps.
std::vector<BlockFootprints::DepthRange> depths_of(std::span<const JoinedFootprint> joined) {
    std::vector<BlockFootprints::DepthRange> all, apart;
    for (const JoinedFootprint &one : joined)
        if (one.depth < one.nearest) all.push_back({one.depth, one.nearest});
    std::ranges::sort(all, {}, &BlockFootprints::DepthRange::farthest);
    for (const auto &range : all)
        if (apart.empty() || range.farthest > apart.back().nearest)
            apart.push_back(range);
        else
            apart.back().nearest = std::max(apart.back().nearest, range.nearest);
    return apart;
}

std::vector<CasterBounds> nearest_first(std::span<const JoinedFootprint> joined) {
    std::vector<CasterBounds> near;
    for (const auto &[footprint, farthest, nearest, sample] : joined) {
        const auto &[place, coc] = footprint;
        const auto [least, most] = std::ranges::minmax(coc);
        near.push_back({{{place[0], place[2]}, {place[1], place[3]}},
                        {least, most},
                        {least + farthest, most + nearest},
                        nearest,
                        nearest});
    }
    std::ranges::sort(near, std::ranges::greater(), &CasterBounds::depth_min);
    for (std::size_t n = 1; n < near.size(); ++n) near[n].extend(near[n - 1]);
    return near;
}

} // namespace

void CasterBounds::extend(const CasterBounds &by) {
    const auto add = [](CocRange &range, const CocRange &other) {
        range = {std::min(range.least, other.least), std::max(range.most, other.most)};
    };
    place.extendBy(by.place);
    add(coc, by.coc);
    add(focus, by.focus);
    depth_min = std::min(depth_min, by.depth_min);
    depth_max = std::max(depth_max, by.depth_max);
}

BlockFootprints::BlockFootprints(const Ldi &ldi, const BlockedSamples &samples, std::optional<Links> links)
    : ldi_(ldi), samples_(samples), links_(std::move(links)), made_(samples.blocks.size()),
      computed_(samples.blocks.size()) {
    bounds_.resize(samples.blocks.size(), CasterBounds::none());
    parallel_for(bounds_.size(), [&](std::size_t b) { bounds_[b] = bounds_of(std::uint32_t(b)); });
    for (int row = 0; row < samples.rows; row += in_area)
        for (int column = 0; column < samples.columns; column += in_area) {
            Area area;
            const Position first(column, row);
            for_blocks({first, first + Imath::V2i(in_area - 1)}, [&](std::uint32_t b) {
                if (samples.blocks[b].begin == samples.blocks[b].end) return;
                area.blocks.push_back(b);
                area.bounds.extend(bounds_[b]);
            });
            if (!area.blocks.empty()) areas_.push_back(std::move(area));
        }
}

CasterBounds BlockFootprints::bounds_of(std::uint32_t block) const {
    const SampleBlock &own = samples_.blocks[block];
    if (own.begin == own.end) return CasterBounds::none();
    const float edge = coc_to_edges(links_ ? &*links_ : nullptr, pixels_of(block));
    return {{{own.x_min, own.y_min}, {own.x_max, own.y_max}},
            {own.coc_min - edge, own.coc_max + edge},
            {own.focus_min - edge, own.focus_max + edge},
            own.depth_min,
            own.depth_max};
}

const std::vector<JoinedFootprint> &BlockFootprints::Block::apart_from(float farthest, float nearest) const {
    const auto behind = [&](const DepthRange &range) { return !(range.nearest > farthest); };
    const auto range = std::ranges::partition_point(joined_over, behind);
    return range != joined_over.end() && range->farthest <= nearest ? alone : joined;
}

const CasterBounds *BlockFootprints::Block::nearer_than(float depth) const {
    const auto is_nearer = [&](const CasterBounds &bounds) { return bounds.depth_min > depth; };
    const auto end = std::ranges::partition_point(near, is_nearer);
    return end == near.begin() ? nullptr : &end[-1];
}

const BlockFootprints::Block &BlockFootprints::of(std::uint32_t block) const {
    std::call_once(made_[block], [&] {
        Block &made = computed_[block];
        const std::vector<Footprint> footprints = compute(block);
        const SampleBlock &own = samples_.blocks[block];
        const SampleRun run{own.begin, own.end};
        made.joined = joined(in_picture(), run, own.opaque_end, footprints);
        made.joined_over = depths_of(made.joined);
        if (!made.joined_over.empty()) made.alone = joined(in_picture(), run, own.begin, footprints);
        made.near = nearest_first(made.joined);
    });
    return computed_[block];
}

SamplesInPicture BlockFootprints::in_picture() const {
    return {samples_.x,     samples_.y,      samples_.hiding_coc(),
            samples_.upper, samples_.source, links_ ? &*links_ : nullptr};
}

std::vector<Footprint> BlockFootprints::compute(std::uint32_t block) const {
    std::vector<SampleRun> around;
    for_blocks({at(block) - Imath::V2i(1), at(block) + Imath::V2i(1)}, [&](std::uint32_t b) {
        around.push_back({samples_.blocks[b].begin, samples_.blocks[b].end});
    });
    const SampleBlock &own = samples_.blocks[block];
    return footprints_of(ldi_, in_picture(), pixels_of(block), {own.begin, own.end}, around);
}

} // namespace sparselens
