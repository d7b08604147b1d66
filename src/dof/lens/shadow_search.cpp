#include "dof/lens/shadow_search.h"

#include "dof/lens/cells.h"
#include "dof/tuning.h"

namespace sparselens {

void ShadowSearch::begin(const Imath::V2d &extent, const CoarseCasters *coarse) {
    extent_ = extent;
    while (casters_.size() > own_) casters_.pop_back();
    cell_px_ = coarse ? coarse->sets.front().across : 0;
    if (!coarse) return;
    far_cells_ = coarse->far_cells;
    for (const ShadowCasters &set : coarse->sets) casters_.push_back(set);
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
                                           const Imath::Box2f &place) const {
    const Range range = range_of(lamp, casters);
    return casters.is_coarse() || lamp.is_beside(place) ? range : Range{lamp.hardly, range.nearest};
}

// Returns the lens points through which the lamps of a group may light its screen (lens/lamp_shadow.h).
Imath::Box2f ShadowSearch::lens_points_of(const ShadowedLamp &lamp) const {
    const ShadowScreen &screen = lamp.screen;
    Imath::Box2f lens_points;
    for (const int axis : {0, 1}) {
        constexpr double rounding = 0.01; // pixels
        const double extent = extent_[axis],
                     apart = (lamp.spread + extent * lamp.cocs + rounding) / std::abs(lamp.lamp.coc);
        const auto through = [&](int pixel) { return (pixel - screen.middle[axis]) / screen.scale[axis]; };
        const auto [least, most] =
            std::minmax({through(screen.box.min[axis]), through(screen.box.max[axis] + 1)});
        // In this order, NaN gives the whole lens.
        lens_points.min[axis] = float(std::min(std::max(-extent, least - apart), extent));
        lens_points.max[axis] = float(std::max(std::min(extent, most + apart), -extent));
    }
    return lens_points;
}

// Whether one of the lens points may bring something in these bounds, in a range of depths, in front of the lamp. A
// lens point moves them by the difference of their CoCs.
bool ShadowSearch::is_before(const ShadowedLamp &lamp, const Imath::Box2f &lens_points,
                             const ShadowCasters &casters, const CasterBounds &bounds,
                             const Range &range) const {
    const CocRange cocs = bounds.cocs_between(range.farthest, range.nearest);
    if (cocs.least > cocs.most) return false;
    const float coc = float(lamp.lamp.coc) / casters.across, group = float(lamp.cocs) / casters.across,
                low = coc - cocs.most - group, high = coc - cocs.least + group;
    const auto reaches = [&](int axis) {
        constexpr float edge = 1.01f; // pixels by which a footprint lies beside its sample, with rounding
        const float beside = edge + float(lamp.spread) / casters.across, first = lens_points.min[axis],
                    last = lens_points.max[axis];
        const auto [least, most] = std::minmax({low * first, low * last, high * first, high * last});
        const float at =
            (float(lamp.origin[axis] + lamp.lamp.centre[axis]) - casters.corner[axis]) / casters.across;
        return bounds.place.min[axis] - beside <= at + most && bounds.place.max[axis] + beside >= at + least;
    };
    return reaches(0) && reaches(1);
}

// Whether the shadow of what is in these bounds and in a range of depths may lie on the screen.
bool ShadowSearch::shadows_screen(const ShadowedLamp &asked, const Imath::Box2f &lens_points,
                                  const ShadowCasters &casters, const CasterBounds &bounds,
                                  const Range &range) const {
    const CocRange cocs = bounds.cocs_between(range.farthest, range.nearest);
    if (cocs.least > cocs.most) return false;
    const Lamp &lamp = asked.lamp;
    const ShadowScreen &screen = asked.screen;
    const double cell = double(casters.across), least_coc = cell * double(cocs.least),
                 most_coc = cell * double(cocs.most);
    if (least_coc <= lamp.coc && most_coc >= lamp.coc)
        return is_before(asked, lens_points, casters, bounds, range);
    const auto reach = [&](int axis) {
        const double a = shadow_magnification(lamp.coc, least_coc, screen.scale[axis]),
                     b = shadow_magnification(lamp.coc, most_coc, screen.scale[axis]);
        // A footprint reaches less than a cell from its sample.
        const double half = std::max(std::abs(a), std::abs(b)) * (cell + asked.spread) + asked.spread;
        const double lamp_at = asked.origin[axis] + lamp.centre[axis] - double(casters.corner[axis]);
        const double low = cell * double(bounds.place.min[axis]) - lamp_at,
                     high = cell * double(bounds.place.max[axis]) - lamp_at;
        const auto [begins, ends] = std::minmax({a * low, a * high, b * low, b * high});
        const double begin = screen.middle[axis] + begins - half, end = screen.middle[axis] + ends + half;
        return end >= double(screen.box.min[axis]) && begin <= double(screen.box.max[axis] + 1);
    };
    return reach(0) && reach(1);
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

} // namespace sparselens
