#include "dof/lens/block_footprints.h"

#include <algorithm>
#include <utility>

namespace sparselens {

namespace {

NearSteps steps_of(std::span<const JoinedFootprint> footprints) {
    constexpr std::size_t in_step = 1; // bounds that include samples at the lamp's depth would tell nothing
    std::vector<NearBounds> bounds;
    bounds.reserve(footprints.size() + 1);
    for (const auto &[footprint, farthest, nearest, sample] : footprints) {
        const auto &[place, coc] = footprint;
        const auto [least, most] = std::ranges::minmax(coc);
        bounds.push_back({nearest, place[0], place[1], place[2], place[3], least, most});
    }
    return {std::move(bounds), in_step};
}

} // namespace

BlockFootprints::BlockFootprints(const Ldi &ldi, const BlockedSamples &samples, std::optional<Links> links)
    : ldi_(ldi), samples_(samples), links_(std::move(links)), areas_(samples, links_ ? &*links_ : nullptr),
      made_(samples.blocks.size()), computed_(samples.blocks.size()) {}

const std::vector<JoinedFootprint> &BlockFootprints::Block::apart_from(float farthest, float nearest) const {
    const bool parts = std::ranges::any_of(joined, [&](const JoinedFootprint &one) {
        return one.depth <= nearest && one.nearest > farthest && one.depth < one.nearest;
    });
    return parts ? alone : joined;
}

const BlockFootprints::Block &BlockFootprints::of(std::uint32_t block) const {
    std::call_once(made_[block], [&] {
        Block &made = computed_[block];
        const std::vector<Footprint> footprints = compute(block);
        const SampleBlock &own = samples_.blocks[block];
        const SampleRun run{own.begin, own.end};
        made.alone = joined(in_picture(), run, own.begin, footprints);
        made.joined = joined(in_picture(), run, own.opaque_end, footprints);
        made.near = steps_of(made.joined);
    });
    return computed_[block];
}

SamplesInPicture BlockFootprints::in_picture() const {
    return {samples_.x,     samples_.y,      samples_.hiding_coc(),
            samples_.upper, samples_.source, links_ ? &*links_ : nullptr};
}

std::vector<Footprint> BlockFootprints::compute(std::uint32_t block) const {
    constexpr int size = BlockedSamples::size;
    const int column = int(block) % samples_.columns, row = int(block) / samples_.columns;
    std::vector<SampleRun> around;
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, samples_.rows - 1); ++r)
        for (int c = std::max(column - 1, 0); c <= std::min(column + 1, samples_.columns - 1); ++c) {
            const SampleBlock &b = samples_.blocks[std::size_t(r * samples_.columns + c)];
            around.push_back({b.begin, b.end});
        }
    const SampleBlock &own = samples_.blocks[block];
    const Imath::V2i first = Imath::V2i(column, row) * size;
    return footprints_of(ldi_, in_picture(), {first, first + Imath::V2i(size - 1)}, {own.begin, own.end},
                         around);
}

} // namespace sparselens
