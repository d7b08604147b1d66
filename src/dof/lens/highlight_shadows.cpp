#include "dof/lens/highlight_shadows.h"

#include "base/numbers.h"
#include "dof/lens/lens_gather.h"
#include "dof/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

constexpr float one_lamp = GatherTuning::one_lamp;

// The name of a block's first sample as a caster: the same wherever the tile lies, and in all frames.
std::uint32_t name_of(std::uint32_t block, int columns) {
    constexpr int blocks = lens_tile_size / BlockedSamples::size;
    const int column = int(block) % columns % blocks, row = int(block) / columns % blocks;
    return std::uint32_t(row * blocks + column) << 10;
}

} // namespace

// Returns the casters of a block. Each lies in front of all lamps of a group, or in front of none.
const std::vector<JoinedFootprint> &HighlightShadows::casters_of(const ShadowedLamp &lamp,
                                                                 const CastingBlock &b) const {
    const ShadowCasters &casters = search_.casters(b.set);
    const BlockFootprints::Block &block = casters.footprints.of(b.number);
    if (!casters.is_coarse()) return block.apart_from(lamp.depth, lamp.hardly);
    return block.apart_from(search_.far_before(lamp.depth, lamp.lamp.coc) / casters.across,
                            lamp.far / casters.across);
}

void HighlightShadows::begin(const Imath::V2i &origin, double pixel_aspect, const Imath::V2d &extent,
                             const CoarseCasters *coarse) {
    origin_ = origin;
    pixel_aspect_ = pixel_aspect;
    search_.begin(extent, coarse);
}

Imath::V2f HighlightShadows::place(std::uint32_t highlight) const {
    return highlights_.among(samples_).place(highlight);
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

void HighlightShadows::share(std::span<const std::uint32_t> group, const Imath::Box2i &box) {
    in_place_.any = in_disc_.any = false;
    is_moved_ = highlights_.among(samples_).is_moved(group.front());
    group_.reset();
    apart_.clear();
    if (group.size() == 1) return;
    const std::uint32_t middle = middle_of(group);
    const auto depth = [&](std::uint32_t h) { return samples_.depth(highlights_.sample[h]); };
    const auto [farthest, nearest] = std::ranges::minmax(group, {}, depth);
    const Lamp lamp = this->lamp(middle);
    group_ = ShadowedLamp{highlights_.sample[middle],
                          lamp,
                          origin_,
                          {lamp.centre, Imath::V2d(lamp.coc), box},
                          depth(farthest),
                          depth(nearest) + one_surface_px,
                          search_.far_before(depth(nearest), lamp.coc),
                          {}};
    for (const std::uint32_t h : group) {
        group_->place.extendBy(place(h));
        const Lamp member = this->lamp(h);
        group_->spread = std::max(group_->spread, (member.centre - lamp.centre).length());
        group_->cocs = std::max(group_->cocs, std::abs(member.coc - lamp.coc));
    }
    const Imath::V2i moves(int(std::ceil(group_->spread)));
    in_place_.box = box;
    in_disc_.box = {box.min - moves, box.max + moves};
    search_.for_each(*group_, [&](const CastingBlock &b) {
        const ShadowCasters &casters = search_.casters(b.set);
        const ShadowSearch::Range range = search_.range_of(*group_, casters);
        // some coarse casters are far enough in front of the farthest member only
        const float from = casters.is_coarse() ? search_.far_before(group_->depth, lamp.coc) / casters.across
                                               : range.farthest;
        for_each_caster(*group_, b, {from, range.nearest}, [&](const Caster &caster) {
            const ShadowEdges edges = edges_of(*group_, caster);
            if (Shadow *shared = shared_by_all(edges))
                cast_one(*shared, *group_, range, caster, edges);
            else if (may_cast(*group_, caster, edges))
                apart_.push_back(caster);
        });
        return !dark(); // no other shadow changes that
    });
}

// By how many whole pixels a member lies from the middle of its group.
Imath::V2i HighlightShadows::moved(std::uint32_t member) const {
    const Imath::V2d apart = lamp(member).centre - group_->lamp.centre;
    return {int(std::lround(apart.x)), int(std::lround(apart.y))};
}

// Returns the shadow of the group that these edges belong to, or null if it differs from member to member.
HighlightShadows::Shadow *HighlightShadows::shared_by_all(const ShadowEdges &edges) {
    const auto most = float(GatherTuning::shared_shadow_of_radius * std::abs(group_->lamp.coc) /
                            std::max(group_->spread, 1e-3));
    const auto all = [&](const Float4 &off) {
        const auto within = (off <= most) & (off >= -most);
        return (within[0] & within[1] & within[2] & within[3]) != 0;
    };
    return all(1 - edges.magnified) ? &in_place_ : all(edges.magnified) ? &in_disc_ : nullptr;
}

bool HighlightShadows::cast(std::uint32_t highlight, const ShadowScreen &screen) {
    const std::uint32_t sample = highlights_.sample[highlight];
    const float depth = samples_.depth(sample);
    const Imath::V2f at = place(highlight);
    const Lamp lamp = this->lamp(highlight);
    const float far = search_.far_before(depth, group_ ? group_->lamp.coc : lamp.coc);
    const ShadowedLamp asked{sample, lamp, origin_, screen, depth, depth + one_surface_px, far, {at, at}};
    own_.any = false;
    own_.box = screen.box;
    if (!group_)
        search_.for_each(asked, [&](const CastingBlock &b) {
            const ShadowSearch::Range range = search_.range_of(asked, search_.casters(b.set));
            for_each_caster(asked, b, range, [&](const Caster &caster) {
                cast_one(own_, asked, range, caster, edges_of(asked, caster));
            });
            return !own_.dark(); // no other shadow changes that
        });
    ShadowSearch::Range range{};
    for (const ShadowCasters *of = nullptr; const Caster &caster : apart_) {
        if (of != caster.of) of = caster.of, range = search_.range_of(asked, *of);
        cast_one(own_, asked, range, caster, edges_of(asked, caster));
        if (own_.dark()) break;
    }
    if (!group_ || !(own_.any || in_disc_.any)) return own_.any || in_place_.any;
    if (in_place_.any) own_.add(in_place_, {0, 0});
    if (in_disc_.any) own_.add(in_disc_, moved(highlight));
    return true;
}

float HighlightShadows::lit(int x, int y, const LampDisc *disc) const {
    return (own_.any ? own_ : in_place_).lamp.lit(x, y, disc);
}

template <typename Visit>
void HighlightShadows::for_each_caster(const ShadowedLamp &lamp, const CastingBlock &b,
                                       const ShadowSearch::Range &range, const Visit &visit) const {
    const ShadowCasters &casters = search_.casters(b.set);
    const std::uint32_t first = casters.samples.blocks[b.number].begin,
                        name = name_of(b.number, casters.samples.columns);
    for (const JoinedFootprint &joined : casters_of(lamp, b))
        if (range.has(joined.depth)) visit(Caster{&casters, &joined, name + (joined.sample - first)});
}

// Whether `sample` is another highlight's, in another pixel, and no nearer than a part of the same lamp would be.
bool HighlightShadows::are_side_by_side(std::uint32_t lamp_sample, std::uint32_t sample) const {
    const auto same = [&](std::span<const float> along) {
        return std::floor(along[lamp_sample]) == std::floor(along[sample]);
    };
    return samples_.depth(sample) <= one_lamp * samples_.depth(lamp_sample) &&
           !(same(samples_.x) && same(samples_.y)) && std::ranges::binary_search(highlights_.sample, sample);
}

// Whether the caster is a part of the lamp, or of a lamp beside it, that stands where the lamp was before it moved.
bool HighlightShadows::is_left_behind(std::uint32_t lamp_sample, const Caster &caster) const {
    const BlockedSamples &of = caster.of->samples;
    const std::uint32_t sample = of.named.empty() ? caster.joined->sample : of.named[caster.joined->sample];
    return is_moved_ && caster.joined->depth <= one_lamp * samples_.depth(lamp_sample) &&
           std::ranges::binary_search(highlights_.sample, sample);
}

// Whether the caster is a part of the mirror or glass that shows the lamp.
bool HighlightShadows::is_in_mirror_of(std::uint32_t lamp_sample, const Caster &caster) const {
    return &caster.of->samples == &samples_ && samples_.is_image(lamp_sample) &&
           samples_.is_image(caster.joined->sample) &&
           kernels::is_in_mirror(samples_.depth(lamp_sample), caster.joined->depth);
}

// Whether the caster has almost no parallax with the lamp, up to the depth `hardly`, and does not cover it.
bool HighlightShadows::casts_hardly(const ShadowedLamp &lamp, float hardly, const Caster &caster) {
    const std::array<float, 4> &place = caster.joined->footprint.place;
    return !caster.of->is_coarse() && caster.joined->depth <= hardly &&
           !lamp.is_beside({{place[0], place[2]}, {place[1], place[3]}});
}

ShadowEdges HighlightShadows::edges_of(const ShadowedLamp &lamp, const Caster &caster) {
    return {lamp, caster.of->across, caster.of->corner, caster.joined->footprint};
}

// Whether the caster may cast a shadow on some member of the group.
bool HighlightShadows::may_cast(const ShadowedLamp &group, const Caster &caster, const ShadowEdges &edges) {
    return !casts_hardly(group, group.depth + one_surface_px, caster) && edges.may_reach(group);
}

void HighlightShadows::cast_one(Shadow &into, const ShadowedLamp &lamp, const ShadowSearch::Range &range,
                                const Caster &caster, const ShadowEdges &edges) const {
    const std::uint32_t sample = caster.joined->sample;
    if (!range.has(caster.joined->depth)) return;
    if (casts_hardly(lamp, lamp.hardly, caster) || is_in_mirror_of(lamp.sample, caster)) return;
    const Imath::Box2f shadow = edges.shadow();
    if (edges.as_blurred() || !reaches(shadow, into.box)) return;
    const float alpha = caster.of->samples.alpha[sample];
    const bool opaque = is_opaque(alpha); // as solids are
    if (!caster.of->is_coarse() && is_left_behind(lamp.sample, caster)) return;
    if (!opaque && !caster.of->is_coarse() && are_side_by_side(lamp.sample, sample)) return;
    into.hide(shadow, opaque ? 1 : alpha, caster.name, lamp.screen.fine);
}

} // namespace sparselens
