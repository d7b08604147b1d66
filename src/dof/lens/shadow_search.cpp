#include "dof/lens/shadow_search.h"

#include "dof/lens/cells.h"
#include "dof/lens/lens_gather.h"
#include "dof/tuning.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>

namespace sparselens {

void ShadowSearch::begin(const CasterBlocks &blocks, const Imath::V2d &extent, const CoarseCasters *coarse) {
    extent_ = extent;
    by_area_.clear();
    while (casters_.size() > own_) casters_.pop_back();
    for (std::size_t set = 0; set < own_; ++set) add_blocks(set, blocks[set]);
    cell_px_ = coarse ? coarse->sets.front().across : 0;
    if (!coarse) return;
    far_cells_ = coarse->far_cells;
    for (const ShadowCasters &set : coarse->sets) casters_.push_back(set);
    for (std::size_t set = own_; set < casters_.size(); ++set) add_blocks(set, coarse->blocks[set - own_]);
}

// Adds the blocks in the order of all areas.
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

float ShadowSearch::far_before(float depth, double coc) const {
    return cell_px_ > 0 && std::abs(coc) >= double(GatherTuning::normal_cells * cell_px_)
               ? depth + far_cells_ * cell_px_
               : INFINITY;
}

ShadowSearch::Range ShadowSearch::range_of(const ShadowedLamp &lamp, const ShadowCasters &casters) const {
    if (casters.is_coarse()) return {lamp.far / casters.across, INFINITY};
    // A surface may lie on both sides of that depth. The margin makes a surface that is one in a cell cast its shadow
    // at least once.
    return {lamp.depth, lamp.far + GatherTuning::one_cell * cell_px_};
}

ShadowSearch::Range ShadowSearch::range_of(const ShadowedLamp &lamp, const ShadowCasters &casters,
                                           const SampleBlock &block) const {
    const Range range = range_of(lamp, casters);
    return casters.is_coarse() ? range : Range{lamp.nearer_than(block), range.nearest};
}

// Whether some lens point may bring one of the block's samples in front of the lamp. They approach by at most the
// difference of their CoCs. This is for casters as blurred as the lamp, whose shadows may have any size.
bool ShadowSearch::is_before(const ShadowedLamp &lamp, const ShadowCasters &casters,
                             const NearBounds &block) const {
    // Cells: how far a footprint's edge lies beside its sample, and by how much their CoCs differ.
    constexpr double of_edge = 1;
    const double cell = double(casters.across), coc = lamp.lamp.coc,
                 apart = std::max(coc - cell * double(block.coc_min), cell * double(block.coc_max) - coc);
    const auto reaches = [&](int axis, float from, float to) {
        const double by = (apart + cell * of_edge) * extent_[axis] + cell * of_edge + lamp.spread;
        const double at = lamp.origin[axis] + lamp.lamp.centre[axis] - double(casters.corner[axis]);
        return cell * double(from) - by <= at && cell * double(to) + by >= at;
    };
    return reaches(0, block.x_min, block.x_max) && reaches(1, block.y_min, block.y_max);
}

// Returns where on the screen the shadow of a sample in these bounds, with a CoC in `cocs`, may lie; empty: nowhere.
Imath::Box2f ShadowSearch::shadow_of(const ShadowedLamp &asked, const ShadowCasters &casters,
                                     const NearBounds &of, const CocRange &cocs) const {
    const NearBounds block{0,
                           of.x_min,
                           of.x_max,
                           of.y_min,
                           of.y_max,
                           std::max(of.coc_min, cocs.least),
                           std::min(of.coc_max, cocs.most)};
    if (block.coc_min > block.coc_max) return {};
    const Lamp &lamp = asked.lamp;
    const ShadowScreen &screen = asked.screen;
    const double cell = double(casters.across), least_coc = cell * double(block.coc_min),
                 most_coc = cell * double(block.coc_max);
    const Imath::Box2f all(Imath::V2f(screen.box.min), Imath::V2f(screen.box.max + Imath::V2i(1)));
    if (least_coc <= lamp.coc && most_coc >= lamp.coc)
        return is_before(asked, casters, block) ? all : Imath::Box2f();
    Imath::Box2f shadow;
    const auto reach = [&](int axis, float from, float to) {
        const double a = shadow_magnification(lamp.coc, least_coc, screen.scale[axis]),
                     b = shadow_magnification(lamp.coc, most_coc, screen.scale[axis]);
        // A footprint reaches less than a cell from its sample.
        const double half = std::max(std::abs(a), std::abs(b)) * (cell + asked.spread) + asked.spread;
        const double lamp_at = asked.origin[axis] + lamp.centre[axis] - double(casters.corner[axis]);
        const double low = cell * double(from) - lamp_at, high = cell * double(to) - lamp_at;
        const auto [begins, ends] = std::minmax({a * low, a * high, b * low, b * high});
        const double begin = screen.middle[axis] + begins - half, end = screen.middle[axis] + ends + half;
        shadow.min[axis] = float(std::max(begin, double(all.min[axis])));
        shadow.max[axis] = float(std::min(end, double(all.max[axis])));
        return !(end < double(all.min[axis]) || begin > double(all.max[axis]));
    };
    return reach(0, block.x_min, block.x_max) && reach(1, block.y_min, block.y_max) ? shadow : Imath::Box2f();
}

// Returns the CoCs of the samples of an area that may cast a shadow; none if none may. Must be called before the area's
// blocks are tested.
std::optional<CocRange> ShadowSearch::cocs_of(const ShadowedLamp &lamp, std::size_t set,
                                              std::size_t area) const {
    const ShadowCasters &casters = casters_[set];
    const ShadowAreas &areas = casters.footprints.areas();
    const Range range = range_of(lamp, casters);
    if (!areas.lies_between(area, range.farthest, range.nearest)) return {};
    const NearBounds *bounds = areas.nearer_than(area, range.farthest);
    if (!bounds) return {};
    const CocRange cocs = areas.cocs_between(area, range.farthest, range.nearest);
    return shadow_of(lamp, casters, *bounds, cocs).isEmpty() ? std::nullopt : std::optional(cocs);
}

std::optional<CastingBlock> ShadowSearch::casting(const ShadowedLamp &lamp, std::size_t set, std::uint32_t b,
                                                  const CocRange &cocs) const {
    const ShadowCasters &casters = casters_[set];
    const auto &[samples, footprints, across, corner] = casters;
    const SampleBlock &block = samples.blocks[b];
    const auto [farthest, nearest] = range_of(lamp, casters, block);
    if (!footprints.areas().block_lies_between(b, farthest, nearest)) return {};
    // shadow_of() allows for edges whose CoC differs from the sample's by half a pixel. On steep surfaces it differs by
    // more.
    const float steep = footprints.areas().to_edges(b) - torn_px / 2;
    const NearBounds all{0,           block.x_min,           block.x_max,          block.y_min,
                         block.y_max, block.coc_min - steep, block.coc_max + steep};
    Imath::Box2f shadow = shadow_of(lamp, casters, all, cocs);
    if (shadow.isEmpty()) return {};
    if (block.depth_min <= farthest) { // some of it lies behind the lamp
        const NearBounds *near = footprints.of(b).near.nearer_than(farthest);
        if (!near) return {};
        shadow = shadow_of(lamp, casters, *near, cocs);
        if (shadow.isEmpty()) return {};
    }
    return CastingBlock{b, std::uint32_t(set), shadow};
}

// The lamps of a group differ in position and in CoC. Both move an edge; the CoC does so by changing the magnification.
bool ShadowEdges::may_reach(const ShadowedLamp &group) const {
    const auto spread = float(group.spread), cocs = float(group.cocs);
    const Float4 apart = float(group.lamp.coc) - coc;
    Imath::Box2f box = shadow();
    for (const int axis : {0, 1}) {
        constexpr float rounding = 0.01f; // pixels
        float moves = 0;                  // pixels
        for (const int k : {2 * axis, 2 * axis + 1}) {
            const float least = std::abs(apart[k]) - 2 * cocs;
            if (!(least > 0)) return true;
            const float magnifies = std::abs(coc[k]) / (least * std::abs(apart[k])) * cocs;
            moves = std::max(moves, std::abs(1 - magnified[k]) * spread +
                                        magnifies * (std::abs(from_lamp[k]) + spread));
        }
        box.min[axis] -= moves + rounding, box.max[axis] += moves + rounding;
    }
    return reaches(box, group.screen.box);
}

namespace {

constexpr float wide = lens_tile_size / 2;   // pixels of CoC, from which on a disc reaches several tiles
constexpr std::size_t all_blocks = 2u << 20; // in all lists: 64 MB
constexpr std::size_t longest_of_many = 64;  // blocks

} // namespace

ShadowLists::ShadowLists(const Highlights &highlights, const BlockedSamples &samples)
    : number_(highlights.sample.size(), none) {
    std::uint32_t lists = 0;
    if (highlights.sample.empty()) return;
    const auto number = [&](std::span<const std::uint32_t> group) {
        const std::uint32_t first = group.front();
        if (std::abs(samples.coc[highlights.sample[first]]) >= wide) number_[first] = lists++;
    };
    for (std::uint32_t b = 0; b < samples.blocks.size(); ++b) highlights.groups.for_each(b, number);
    Imath::Box2f all;
    all.makeInfinite();
    highlights.groups.for_each_moved(all, 1, number);
    lists_ = std::vector<List>(lists);
    longest_ = std::max(longest_of_many, all_blocks / std::max<std::size_t>(lists, 1));
}

} // namespace sparselens
