#include "dof/lens/block_footprints.h"

#include <algorithm>
#include <utility>

namespace sparselens {

BlockFootprints::BlockFootprints(const Ldi &ldi, const BlockedSamples &samples, std::optional<Links> links)
    : ldi_(ldi), samples_(samples), links_(std::move(links)), areas_(samples, links_ ? &*links_ : nullptr),
      made_(samples.blocks.size()), computed_(samples.blocks.size()) {}

const BlockFootprints::Block &BlockFootprints::of(std::uint32_t block) const {
    std::call_once(made_[block], [&] {
        Block &made = computed_[block];
        made.footprints = compute(block);
        made.near = steps_of(samples_.blocks[block], made.footprints);
    });
    return computed_[block];
}

NearSteps BlockFootprints::steps_of(const SampleBlock &block, std::span<const Footprint> footprints) const {
    constexpr std::size_t in_step = 1; // with others at the depth of the lamp, bounds would tell nothing
    std::vector<NearBounds> samples;
    samples.reserve(footprints.size() + 1);
    for (std::size_t i = 0; i < footprints.size(); ++i) {
        const auto &[place, coc] = footprints[i];
        const auto [least, most] = std::ranges::minmax(coc);
        samples.push_back(
            {samples_.depth(block.begin + i), place[0], place[1], place[2], place[3], least, most});
    }
    return {std::move(samples), in_step};
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
    return footprints_of(ldi_,
                         {samples_.x, samples_.y, samples_.hiding_coc(), samples_.upper, samples_.source,
                          links_ ? &*links_ : nullptr},
                         {first, first + Imath::V2i(size - 1)}, {own.begin, own.end}, around);
}

} // namespace sparselens
