// Finds the blocks of samples that may cast a shadow on a lamp (highlight_shadows.h).
//
// A sample hides a lamp only if some point of the lens sees it in front of the lamp. So the search compares bounds
// (block_footprints.h) by their distance from the lamp and by how far they are moved apart by those points of the lens
// through which the lamp lights the screen.
#pragma once

#include "base/numbers.h"
#include "dof/footprints/footprint.h"
#include "dof/lens/block_footprints.h"
#include "dof/lens/sample_blocks.h"
#include "lens/lamp_shadow.h"
#include "lens/lamp_spread.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace sparselens {

// A screen on which shadows are cast. The shadow of a point at x' with CoC c', for a lamp at x with CoC c, lies at
// middle + scale (x' - x) / (c - c').
struct ShadowScreen {
    Imath::V2d middle, scale;
    Imath::Box2i box;
    bool fine = false; // in cells of the lens, not in pixels
};

// The samples that cast shadows: of the scene of the highlights, or of a coarse scene.
struct ShadowCasters {
    const BlockedSamples &samples;
    const BlockFootprints &footprints;
    // The width and height of one of their cells, and the origin of their positions, in pixels of the highlights'
    // scene.
    float across = 1;
    Imath::V2f corner = {0, 0};
    bool is_coarse() const { return across > 1; }
};

// The samples of a scene first, then its solids, then its fillers that hide lamps.
using CasterSets = std::vector<ShadowCasters>;

// The casters of a coarse scene.
struct CoarseCasters {
    CasterSets sets;
    float far_cells; // so many cells of disparity in front of a lamp, these cast its shadows
};

// A lamp, or the middle one of a group.
struct ShadowedLamp {
    std::uint32_t sample;
    Lamp lamp;
    Imath::V2i origin; // origin of its position and of its screen, relative to the data window's corner
    ShadowScreen screen;
    // A caster only slightly nearer than the lamp, up to the depth `hardly`, has almost no parallax; it counts only if
    // it covers the lamp directly.
    float depth, hardly;
    float far;          // disparity, pixels, from which on coarse casters are used; infinite: there are none
    Imath::Box2f place; // of all lamps of the group
    double spread = 0;  // pixels: the radius of the group around it
    double cocs = 0;    // pixels: by how much the group's CoCs differ from its own at most

    bool is_beside(const Imath::Box2f &box) const {
        constexpr float beside = 2; // pixels
        return box.min.x < place.max.x + beside && box.max.x > place.min.x - beside &&
               box.min.y < place.max.y + beside && box.max.y > place.min.y - beside;
    }
};

struct CastingBlock {
    std::uint32_t number, set; // the block, and the number of its set of casters
};

class ShadowSearch {
public:
    explicit ShadowSearch(CasterSets sets) : casters_(std::move(sets)), own_(casters_.size()) {}

    // Begins a tile. `extent`: of the lens, pixels per pixel of CoC.
    void begin(const Imath::V2d &extent, const CoarseCasters *coarse);

    const ShadowCasters &casters(std::size_t set) const { return casters_[set]; }
    // The range of disparities, in the pixels of a set of casters, in which its casters cast shadows.
    struct Range {
        float farthest, nearest;
        bool has(float depth) const { return depth > farthest && depth <= nearest; }
    };
    Range range_of(const ShadowedLamp &lamp, const ShadowCasters &casters) const;
    // The same for casters that lie in a box.
    Range range_of(const ShadowedLamp &lamp, const ShadowCasters &casters, const Imath::Box2f &place) const;
    // The disparity from which on coarse casters cast the shadows on a lamp, or on a group around it.
    float far_before(float depth, double coc) const;

    // Calls visit(block), until it returns false, for the blocks that may cast a shadow on the lamp's screen.
    template <typename Visit>
    void for_each(const ShadowedLamp &lamp, const Visit &visit) const;

private:
    Imath::Box2f lens_points_of(const ShadowedLamp &lamp) const;
    bool is_before(const ShadowedLamp &lamp, const Imath::Box2f &lens_points, const ShadowCasters &casters,
                   const CasterBounds &bounds, const Range &range) const;
    bool shadows_screen(const ShadowedLamp &lamp, const Imath::Box2f &lens_points,
                        const ShadowCasters &casters, const CasterBounds &bounds, const Range &range) const;

    CasterSets casters_; // and those of the tile's coarse scene
    std::size_t own_;    // how many of them are not coarse
    Imath::V2d extent_{1, 1};
    float cell_px_ = 0, far_cells_ = 0; // of the tile's coarse casters; 0: there are none
};

// Whether any sample of a block lies between two disparities.
inline bool lie_between(const BlockedSamples &samples, std::uint32_t block, float farthest, float nearest) {
    const auto step = [](float depth) { return std::int32_t(kernels::upper_of_depth(depth)); }; // ascending
    const std::int32_t from = step(farthest), to = step(nearest);
    int count = 0;
    for (std::uint32_t i = samples.blocks[block].begin; i < samples.blocks[block].end; ++i)
        count += int(std::int32_t(samples.upper[i]) > from) & int(std::int32_t(samples.upper[i]) <= to);
    return count > 0;
}

template <typename Visit>
void ShadowSearch::for_each(const ShadowedLamp &lamp, const Visit &visit) const {
    const Imath::Box2f lens_points = lens_points_of(lamp);
    for (std::uint32_t set = 0; set < casters_.size(); ++set) {
        const ShadowCasters &casters = casters_[set];
        const Range range = range_of(lamp, casters);
        const auto pass = [&](const CasterBounds &bounds) {
            return bounds.depth_max > range.farthest && bounds.depth_min <= range.nearest &&
                   is_before(lamp, lens_points, casters, bounds, range);
        };
        const auto visit_block = [&](std::uint32_t b, const CasterBounds &bounds) {
            const Range within = range_of(lamp, casters, bounds.place);
            const CasterBounds *before = bounds.depth_max > within.farthest ? &bounds : nullptr;
            if (bounds.depth_min <= within.farthest)
                before = lie_between(casters.samples, b, within.farthest, within.nearest)
                             ? casters.footprints.of(b).nearer_than(within.farthest)
                             : nullptr;
            return !before || !shadows_screen(lamp, lens_points, casters, *before, within) ||
                   visit(CastingBlock{b, set});
        };
        if (!casters.footprints.for_each(pass, visit_block)) return;
    }
}

// Finds where the four edges of a caster's shadow lie on a lamp's screen (lens/lamp_shadow.h).
struct ShadowEdges {
    // The edges of the footprint, in its order: pixels, except the magnification.
    Float4 coc, magnified, from_lamp, at;

    // `across`, `corner`: as in ShadowCasters.
    ShadowEdges(const ShadowedLamp &lamp, float across, const Imath::V2f &corner, const Footprint &footprint);

    // Whether an edge is as blurred as the lamp and lies directly in front of it; then there is no shadow.
    bool as_blurred() const;
    // The shadow. If an edge is more blurred than the lamp, the shadow lies on its other side.
    Imath::Box2f shadow() const;
    // Whether the shadow on some member of a group may reach the group's screen. This must be the shadow on its middle
    // lamp.
    bool may_reach(const ShadowedLamp &group) const;
};

inline ShadowEdges::ShadowEdges(const ShadowedLamp &lamp, float across, const Imath::V2f &corner,
                                const Footprint &footprint) {
    const auto both = [](const auto &v) { return Float4{float(v.x), float(v.x), float(v.y), float(v.y)}; };
    coc = across * load4(footprint.coc.data());
    magnified = shadow_magnification(float(lamp.lamp.coc) + Float4{}, coc, both(lamp.screen.scale));
    from_lamp =
        across * load4(footprint.place.data()) + both(corner) - both(lamp.origin) - both(lamp.lamp.centre);
    at = both(lamp.screen.middle) + magnified * from_lamp;
}

inline bool ShadowEdges::as_blurred() const {
    return std::isnan(at[0]) || std::isnan(at[1]) || std::isnan(at[2]) || std::isnan(at[3]);
}

inline Imath::Box2f ShadowEdges::shadow() const {
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

// Whether some of a shadow lies in a box of pixels.
inline bool reaches(const Imath::Box2f &shadow, const Imath::Box2i &box) {
    for (const int axis : {0, 1}) {
        const auto begin = float(box.min[axis]), end = float(box.max[axis]) + 1;
        const float low = shadow.min[axis], high = shadow.max[axis];
        if (!(high > begin && low <= end && high > low)) return false;
    }
    return true;
}

} // namespace sparselens
