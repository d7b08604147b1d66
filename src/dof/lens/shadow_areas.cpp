#include "dof/lens/shadow_areas.h"

#include "base/grid.h"

#include <algorithm>
#include <limits>
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

} // namespace

BlockFootprints::BlockFootprints(const Ldi &ldi, const BlockedSamples &samples, std::optional<Links> links)
    : ldi_(ldi), samples_(samples), links_(std::move(links)), areas_(samples, links_ ? &*links_ : nullptr),
      made_(samples.blocks.size()), computed_(samples.blocks.size()) {}

const std::vector<JoinedFootprint> &BlockFootprints::Block::apart_from(float farthest, float nearest) const {
    const auto behind = [&](const DepthRange &range) { return !(range.nearest > farthest); };
    const auto range = std::ranges::partition_point(joined_over, behind);
    return range != joined_over.end() && range->farthest <= nearest ? alone : joined;
}

const BlockFootprints::Block &BlockFootprints::of(std::uint32_t block) const {
    std::call_once(made_[block], [&] {
        Block &made = computed_[block];
        const std::vector<Footprint> footprints = compute(block);
        const SampleBlock &own = samples_.blocks[block];
        const SampleRun run{own.begin, own.end};
        made.alone = joined(in_picture(), run, own.begin, footprints);
        made.joined = joined(in_picture(), run, own.opaque_end, footprints);
        made.joined_over = depths_of(made.joined);
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

namespace {

constexpr float none = std::numeric_limits<float>::infinity();

void extend(NearBounds &bounds, const NearBounds &by) {
    bounds.x_min = std::min(bounds.x_min, by.x_min);
    bounds.x_max = std::max(bounds.x_max, by.x_max);
    bounds.y_min = std::min(bounds.y_min, by.y_min);
    bounds.y_max = std::max(bounds.y_max, by.y_max);
    bounds.coc_min = std::min(bounds.coc_min, by.coc_min);
    bounds.coc_max = std::max(bounds.coc_max, by.coc_max);
}

} // namespace

// Works in place: a step overwrites samples that it already includes.
NearSteps::NearSteps(std::vector<NearBounds> samples, std::size_t in_step) : steps_(std::move(samples)) {
    std::ranges::sort(steps_, std::ranges::greater(), &NearBounds::depth);
    std::size_t steps = 0;
    NearBounds bounds{0, none, -none, none, -none, none, -none};
    for (std::size_t n = 0; n < steps_.size(); ++n) {
        const NearBounds sample = steps_[n];
        bounds.depth = sample.depth;
        if (n % in_step == 0) steps_[steps++] = bounds;
        extend(bounds, sample);
    }
    bounds.depth = -none;
    steps_.resize(steps);
    if (in_step > 1) steps_.shrink_to_fit();
    steps_.push_back(bounds);
}

const NearBounds *NearSteps::nearer_than(float depth) const {
    const auto is_too_few = [&](const NearBounds &step) { return step.depth > depth; };
    const auto step = std::ranges::partition_point(steps_, is_too_few);
    return step == steps_.begin() ? nullptr : &*step;
}

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
