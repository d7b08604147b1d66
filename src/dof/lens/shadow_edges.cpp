#include "dof/lens/shadow_edges.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

ShadowEdges::ShadowEdges(const ShadowedLamp &lamp, float across, const Imath::V2f &corner,
                         const Footprint &footprint) {
    const auto both = [](const auto &v) { return Float4{float(v.x), float(v.x), float(v.y), float(v.y)}; };
    coc = across * load4(footprint.coc.data());
    magnified = shadow_magnification(float(lamp.lamp.coc) + Float4{}, coc, both(lamp.screen.scale));
    from_lamp =
        across * load4(footprint.place.data()) + both(corner) - both(lamp.origin) - both(lamp.lamp.centre);
    at = both(lamp.screen.middle) + magnified * from_lamp;
}

bool ShadowEdges::as_blurred() const {
    return std::isnan(at[0]) || std::isnan(at[1]) || std::isnan(at[2]) || std::isnan(at[3]);
}

Imath::Box2f ShadowEdges::shadow() const {
    Imath::Box2f box;
    for (const int axis : {0, 1}) {
        const int first = 2 * axis, last = first + 1;
        float low = -INFINITY, high = INFINITY;
        (magnified[first] > 0 ? low : high) = at[first];
        if (magnified[last] > 0)
            high = std::min(high, at[last]);
        else
            low = std::max(low, at[last]);
        box.min[axis] = low, box.max[axis] = high;
    }
    return box;
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

bool reaches(const Imath::Box2f &shadow, const Imath::Box2i &box) {
    for (const int axis : {0, 1}) {
        const auto begin = float(box.min[axis]), end = float(box.max[axis]) + 1;
        const float low = shadow.min[axis], high = shadow.max[axis];
        if (!(high > begin && low <= end && high > low)) return false;
    }
    return true;
}

} // namespace sparselens
