#include "dof/lens/shadow_search.h"

#include "dof/lens/cells.h"

#include <algorithm>
#include <unordered_map>

namespace sparselens {

namespace {

// Cells of perceptive depth: so far before a lamp, a cell's shadow is a sixteenth of the disc's radius wide or less.
constexpr float far_cells = 16;

} // namespace

void ShadowSearch::begin(std::span<const std::uint32_t> samples, std::span<const std::uint32_t> solids,
                         const Imath::V2d &extent, const CoarseCasters *coarse) {
    extent_ = extent;
    by_area_.clear();
    while (casters_.size() > 2) casters_.pop_back();
    add_blocks(0, samples);
    add_blocks(1, solids);
    cell_px_ = coarse ? coarse->samples.across : 0;
    if (!coarse) return;
    casters_.push_back(coarse->samples);
    casters_.push_back(coarse->solids);
    add_blocks(2, coarse->blocks);
    add_blocks(3, coarse->solid_blocks);
}

// In the order of all areas.
void ShadowSearch::add_blocks(std::size_t set, std::span<const std::uint32_t> blocks) {
    const std::size_t first = by_area_.size();
    std::unordered_map<std::size_t, std::size_t> known;
    for (const std::uint32_t b : blocks) {
        const std::size_t area = casters_[set].footprints.areas().of(b);
        const auto [at, added] = known.try_emplace(area, by_area_.size());
        if (added) by_area_.push_back({set, area, {}});
        by_area_[at->second].blocks.push_back(b);
    }
    std::ranges::sort(by_area_.begin() + std::ptrdiff_t(first), by_area_.end(), {}, &AreaBlocks::area);
}

float ShadowSearch::far_before(float depth) const {
    return cell_px_ > 0 ? depth + far_cells * cell_px_ : INFINITY;
}

ShadowSearch::Range ShadowSearch::range_of(const ShadowedLamp &lamp, const ShadowCasters &casters) const {
    if (casters.is_coarse()) return {lamp.far / casters.across, INFINITY};
    // A surface may lie on both sides of that depth: what is one in a cell casts its shadow at least once.
    return {lamp.depth, lamp.far + one_cell * cell_px_};
}

ShadowSearch::Range ShadowSearch::range_of(const ShadowedLamp &lamp, const ShadowCasters &casters,
                                           const SampleBlock &block) const {
    const Range range = range_of(lamp, casters);
    return casters.is_coarse() ? range : Range{lamp.nearer_than(block), range.nearest};
}

// Whether any of an area may; asked before its blocks are.
bool ShadowSearch::may_cast(const ShadowedLamp &lamp, std::size_t set, std::size_t area) const {
    const ShadowCasters &casters = casters_[set];
    const ShadowAreas &areas = casters.footprints.areas();
    const Range range = range_of(lamp, casters);
    if (!areas.lies_between(area, range.farthest, range.nearest)) return false;
    const NearBounds *bounds = areas.nearer_than(area, range.farthest);
    return bounds && !shadow_of(lamp, casters, *bounds).isEmpty();
}

} // namespace sparselens
