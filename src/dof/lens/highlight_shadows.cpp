#include "dof/lens/highlight_shadows.h"

#include "dof/lens/cells.h"
#include "dof/lens/lens_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace sparselens {

namespace {

constexpr float one_lamp = 1.1f; // times as near: parts of one, at any aperture
// Cells of perceptive depth: so far before a lamp, a cell's shadow is a sixteenth of the disc's radius wide or less.
constexpr float far_cells = 16;

// Of the first sample of a block: the same wherever the tile lies, and in all frames.
std::uint32_t name_of(std::uint32_t block, int columns) {
    constexpr int blocks = lens_tile_size / BlockedSamples::size;
    const int column = int(block) % columns % blocks, row = int(block) / columns % blocks;
    return std::uint32_t(row * blocks + column) << 10;
}

} // namespace

HighlightShadows::Range HighlightShadows::range_of(const Asked &lamp, const ShadowCasters &casters) const {
    if (casters.is_coarse()) return {lamp.far / casters.across, INFINITY};
    // A surface may lie on both sides of that depth: what is one in a cell casts its shadow at least once.
    return {lamp.depth, lamp.far + one_cell * cell_px_};
}

HighlightShadows::Range HighlightShadows::range_of(const Asked &lamp, const ShadowCasters &casters,
                                                   const SampleBlock &block) const {
    const Range range = range_of(lamp, casters);
    return casters.is_coarse() ? range : Range{lamp.nearer_than(block), range.nearest};
}

// Whether the shadows of what a block has before a group are nearly the same for all of it.
bool HighlightShadows::is_shared(const Asked &group, const Block &b) const {
    const ShadowCasters &casters = casters_[b.set];
    const BlockedSamples &samples = casters.samples;
    const SampleBlock &block = samples.blocks[b.number];
    const std::vector<Footprint> &footprints = casters.footprints.of(b.number).footprints;
    const auto [farthest, nearest] = range_of(group, casters, block);
    const float most = float(group.lamp.coc / 2) / casters.across;
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
        if (!(samples.depth[i] > farthest) || samples.depth[i] > nearest) continue;
        const auto [least_coc, most_coc] = std::ranges::minmax(footprints[i - block.begin].coc);
        if (most > 0 ? most_coc > most : least_coc < most) return false;
    }
    return true;
}

void HighlightShadows::begin(const Imath::V2i &origin, std::span<const std::uint32_t> samples,
                             std::span<const std::uint32_t> solids, double pixel_aspect,
                             const Imath::V2d &extent, const CoarseCasters *coarse) {
    origin_ = origin;
    pixel_aspect_ = pixel_aspect;
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

float HighlightShadows::far_before(float depth) const {
    return cell_px_ > 0 ? depth + far_cells * cell_px_ : INFINITY;
}

void HighlightShadows::add_blocks(std::size_t set, std::span<const std::uint32_t> blocks) {
    std::unordered_map<std::size_t, std::size_t> known;
    for (const std::uint32_t b : blocks) {
        const std::size_t area = casters_[set].footprints.areas().of(b);
        const auto [at, added] = known.try_emplace(area, by_area_.size());
        if (added) by_area_.push_back({set, area, {}});
        by_area_[at->second].blocks.push_back(b);
    }
}

Imath::V2f HighlightShadows::place(std::uint32_t highlight) const {
    const std::uint32_t i = highlights_.sample[highlight];
    return {samples_.x[i], samples_.y[i]};
}

Lamp HighlightShadows::lamp(std::uint32_t highlight) const {
    return {Imath::V2d(place(highlight)) - Imath::V2d(origin_),
            double(samples_.coc[highlights_.sample[highlight]]), pixel_aspect_};
}

std::uint32_t HighlightShadows::middle_of(std::span<const std::uint32_t> group) const {
    Imath::V2d sum(0);
    for (const std::uint32_t h : group) sum += Imath::V2d(place(h));
    const Imath::V2d mean = sum / double(group.size());
    return *std::ranges::min_element(
        group, {}, [&](std::uint32_t h) { return (Imath::V2d(place(h)) - mean).length2(); });
}

// visit(block) for those that may cast a shadow, until it is false.
template <typename Visit>
void HighlightShadows::for_each_block(const Asked &lamp, const Visit &visit) const {
    for (const auto &[set, area, blocks] : by_area_) {
        const ShadowCasters &casters = casters_[set];
        const auto &[samples, footprints, across, corner] = casters;
        const Range range = range_of(lamp, casters);
        const ShadowAreas &areas = footprints.areas();
        if (!areas.lies_between(area, range.farthest, range.nearest)) continue;
        const NearBounds *bounds = areas.nearer_than(area, range.farthest);
        if (!bounds || !can_shadow(lamp, casters, *bounds)) continue;
        for (const std::uint32_t b : blocks) {
            const SampleBlock &block = samples.blocks[b];
            const auto [farthest, nearest] = range_of(lamp, casters, block);
            if (!areas.block_lies_between(b, farthest, nearest) || !can_shadow(lamp, casters, block))
                continue;
            if (block.depth_min <= farthest) { // some of it lies behind the lamp
                const NearBounds *near = footprints.of(b).near.nearer_than(farthest);
                if (!near || !can_shadow(lamp, casters, *near)) continue;
            }
            if (!visit(Block{set, b})) return;
        }
    }
}

void HighlightShadows::share(std::span<const std::uint32_t> group, const Imath::Box2i &box) {
    shares_ = false;
    group_.reset();
    apart_.clear();
    if (group.size() == 1) return;
    const std::uint32_t middle = middle_of(group);
    const auto depth = [&](std::uint32_t h) { return samples_.depth[highlights_.sample[h]]; };
    const auto [farthest, nearest] = std::ranges::minmax(group, {}, depth);
    const Lamp lamp = this->lamp(middle);
    group_ = Asked{highlights_.sample[middle],
                   lamp,
                   {lamp.centre, Imath::V2d(lamp.coc), box},
                   depth(farthest),
                   depth(nearest) + one_surface_px,
                   far_before(depth(nearest)),
                   {}};
    for (const std::uint32_t h : group) {
        group_->place.extendBy(place(h));
        group_->spread = std::max(group_->spread, (this->lamp(h).centre - lamp.centre).length());
    }
    for_each_block(*group_, [&](const Block &b) {
        if (!is_shared(*group_, b)) {
            apart_.push_back(b);
            return true;
        }
        if (!shares_) shared_.begin(box);
        shares_ = true;
        cast_block(*group_, b, shared_);
        return !shared_.dark(); // no other shadow changes that
    });
}

bool HighlightShadows::cast(std::uint32_t highlight, const ShadowScreen &screen) {
    const std::uint32_t sample = highlights_.sample[highlight];
    const float depth = samples_.depth[sample];
    const Imath::V2f at = place(highlight);
    const Asked asked{sample,  lamp(highlight), screen, depth, depth + one_surface_px, far_before(depth),
                      {at, at}};
    has_own_ = false;
    const auto cast_own = [&](const Block &b) {
        if (!has_own_) own_.begin(screen.box, screen.fine);
        has_own_ = true;
        cast_block(asked, b, own_);
        return !own_.dark(); // no other shadow changes that
    };
    if (!group_) for_each_block(asked, cast_own);
    for (const Block &b : apart_)
        if (!cast_own(b)) break;
    return shares_ || has_own_;
}

float HighlightShadows::lit(int x, int y, const LampDisc *disc) const {
    return has_own_ ? own_.lit(x, y, disc, shares_ ? &shared_ : nullptr) : shared_.lit(x, y, disc);
}

void HighlightShadows::cast_block(const Asked &lamp, const Block &b, LampShadow &shadow) const {
    const ShadowCasters &casters = casters_[b.set];
    const BlockedSamples &samples = casters.samples;
    const SampleBlock &block = samples.blocks[b.number];
    const std::vector<Footprint> &footprints = casters.footprints.of(b.number).footprints;
    const std::uint32_t first = name_of(b.number, samples.columns);
    const Range range = range_of(lamp, casters);
    const float farthest = casters.is_coarse() ? range.farthest : lamp.hardly;
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
        const float depth = samples.depth[i];
        const Imath::V2f at(samples.x[i], samples.y[i]);
        const bool right_before = !casters.is_coarse() && depth > lamp.depth && lamp.is_beside({at, at});
        if ((depth > farthest || right_before) && depth <= range.nearest)
            cast_one(lamp, casters, i, footprints[i - block.begin], first + i - block.begin, shadow);
    }
}

// Whether some lens point may bring one of its samples before the lamp: they come nearer by the difference of their CoCs at most.
// For what is as blurred as the lamp, whose shadow may be of any size.
template <typename Bounds>
bool HighlightShadows::is_before(const Asked &asked, const ShadowCasters &casters,
                                 const Bounds &block) const {
    constexpr double of_edge =
        1; // cells, by which a footprint's edge lies beside its sample, and pixels of their CoCs
    const double cell = double(casters.across), coc = asked.lamp.coc,
                 apart = std::max(coc - cell * double(block.coc_min), cell * double(block.coc_max) - coc);
    const auto reaches = [&](int axis, float from, float to) {
        const double by = (apart + cell * of_edge) * extent_[axis] + cell * of_edge + asked.spread;
        const double at = origin_[axis] + asked.lamp.centre[axis] - double(casters.corner[axis]);
        return cell * double(from) - by <= at && cell * double(to) + by >= at;
    };
    return reaches(0, block.x_min, block.x_max) && reaches(1, block.y_min, block.y_max);
}

// Whether a shadow of one of its samples may reach the screen.
template <typename Bounds>
bool HighlightShadows::can_shadow(const Asked &asked, const ShadowCasters &casters,
                                  const Bounds &block) const {
    const Lamp &lamp = asked.lamp;
    const ShadowScreen &screen = asked.screen;
    const double cell = double(casters.across), least_coc = cell * double(block.coc_min),
                 most_coc = cell * double(block.coc_max);
    if (least_coc <= lamp.coc && most_coc >= lamp.coc) return is_before(asked, casters, block);
    const auto reaches = [&](int axis, float from, float to) {
        const double a = shadow_magnification(lamp.coc, least_coc, screen.scale[axis]),
                     b = shadow_magnification(lamp.coc, most_coc, screen.scale[axis]);
        // A footprint reaches less than a cell from its sample.
        const double half = std::max(std::abs(a), std::abs(b)) * (cell + asked.spread) + asked.spread;
        const double lamp_at = origin_[axis] + lamp.centre[axis] - double(casters.corner[axis]);
        const double low = cell * double(from) - lamp_at, high = cell * double(to) - lamp_at;
        const auto [least, most] = std::minmax({a * low, a * high, b * low, b * high});
        return !(screen.middle[axis] + most + half < screen.box.min[axis] ||
                 screen.middle[axis] + least - half > screen.box.max[axis] + 1);
    };
    return reaches(0, block.x_min, block.x_max) && reaches(1, block.y_min, block.y_max);
}

// Whether it is another highlight's, of other pixels and no nearer than a part of the same lamp would be.
bool HighlightShadows::are_side_by_side(std::uint32_t lamp_sample, std::uint32_t sample) const {
    const auto same = [&](const std::vector<float> &along) {
        return std::floor(along[lamp_sample]) == std::floor(along[sample]);
    };
    return samples_.depth[sample] <= one_lamp * samples_.depth[lamp_sample] &&
           !(same(samples_.x) && same(samples_.y)) && std::ranges::binary_search(highlights_.sample, sample);
}

void HighlightShadows::cast_one(const Asked &asked, const ShadowCasters &casters, std::uint32_t sample,
                                const Footprint &footprint, std::uint32_t name, LampShadow &into) const {
    const Lamp &lamp = asked.lamp;
    const ShadowScreen &screen = asked.screen;
    const auto coc = float(lamp.coc);
    // Along each axis from where to where. Past an edge that is more blurred than the lamp it is the other way round.
    std::array<float, 2> low{-INFINITY, -INFINITY}, high{INFINITY, INFINITY};
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t axis = k / 2;
        const float m =
            shadow_magnification(coc, casters.across * footprint.coc[k], float(screen.scale[int(axis)]));
        const float place = casters.across * footprint.place[k] + casters.corner[int(axis)];
        const float edge = float(screen.middle[int(axis)]) +
                           m * (place - float(origin_[int(axis)]) - float(lamp.centre[int(axis)]));
        const bool from_edge_on = (k % 2 == 0) == (m > 0);
        if (from_edge_on)
            low[axis] = std::max(low[axis], edge);
        else
            high[axis] = std::min(high[axis], edge);
        if (std::isnan(edge)) return; // as blurred as the lamp, and right before it
    }
    const Imath::Box2f shadow({low[0], low[1]}, {high[0], high[1]});
    if (!(high[0] > float(screen.box.min.x) && low[0] <= float(screen.box.max.x) + 1 && high[0] > low[0] &&
          high[1] > float(screen.box.min.y) && low[1] <= float(screen.box.max.y) + 1 && high[1] > low[1]))
        return;
    const float alpha = casters.samples.alpha[sample];
    const bool opaque = is_opaque(alpha); // as solids are
    if (!opaque && !casters.is_coarse() && are_side_by_side(asked.sample, sample)) return;
    into.hide(shadow, opaque ? 1 : alpha, name);
}

} // namespace sparselens
