// Finds the blocks of samples that may cast a shadow on a lamp (highlight_shadows.h).
//
// The search compares bounds: of areas of blocks (shadow_areas.h), of blocks, and of what each of these has nearer than
// the lamp.
#pragma once

#include "base/numbers.h"
#include "dof/footprints/footprint.h"
#include "dof/lens/highlights.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/shadow_areas.h"
#include "lens/lamp_shadow.h"
#include "lens/lamp_spread.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
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

// The samples of a scene first, then its solids, then its fillers that hide lamps; and blocks of each.
using CasterSets = std::vector<ShadowCasters>;
using CasterBlocks = std::vector<std::span<const std::uint32_t>>;

// The casters of a coarse scene that can reach a tile.
struct CoarseCasters {
    CasterSets sets;
    CasterBlocks blocks;
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
    float nearer_than(const SampleBlock &block) const {
        return is_beside({{block.x_min, block.y_min}, {block.x_max, block.y_max}}) ? depth : hardly;
    }
};

struct CastingBlock {
    std::uint32_t number, set; // the block, and the number of its set of casters
    Imath::Box2f shadow;       // where it may lie on the lamp's screen
    bool apart = false;        // whether its shadow differs between the lamps of a group
};

class ShadowSearch {
public:
    explicit ShadowSearch(CasterSets sets) : casters_(std::move(sets)), own_(casters_.size()) {}

    // Begins a tile, with the blocks that can reach it. `extent`: of the lens, pixels per pixel of CoC.
    void begin(const CasterBlocks &blocks, const Imath::V2d &extent, const CoarseCasters *coarse);

    const ShadowCasters &casters(std::size_t set) const { return casters_[set]; }
    // The range of disparities, in the pixels of a set of casters, in which its casters cast shadows.
    struct Range {
        float farthest, nearest;
    };
    Range range_of(const ShadowedLamp &lamp, const ShadowCasters &casters) const;
    Range range_of(const ShadowedLamp &lamp, const ShadowCasters &casters, const SampleBlock &block) const;
    // The disparity from which on coarse casters cast the shadows on a lamp, or on a group around it.
    float far_before(float depth, double coc) const;

    // Calls visit(block), until it returns false, for the blocks that may cast a shadow on the lamp's screen: of the
    // blocks that can reach the tile, or of all blocks. Both use the same order, set by set.
    template <typename Visit>
    void in_tile(const ShadowedLamp &lamp, const Visit &visit) const;
    template <typename Visit>
    void in_picture(const ShadowedLamp &lamp, const Visit &visit) const;

private:
    void add_blocks(std::size_t set, std::span<const std::uint32_t> blocks);
    std::optional<CocRange> cocs_of(const ShadowedLamp &lamp, std::size_t set, std::size_t area) const;
    template <typename Visit>
    bool in_blocks(const ShadowedLamp &lamp, std::size_t set, std::span<const std::uint32_t> blocks,
                   const CocRange &cocs, const Visit &visit) const;
    std::optional<CastingBlock> casting(const ShadowedLamp &lamp, std::size_t set, std::uint32_t block,
                                        const CocRange &cocs) const;
    bool is_before(const ShadowedLamp &lamp, const ShadowCasters &casters, const NearBounds &bounds) const;
    Imath::Box2f shadow_of(const ShadowedLamp &lamp, const ShadowCasters &casters, const NearBounds &bounds,
                           const CocRange &cocs) const;

    CasterSets casters_; // and those of the tile's coarse scene
    std::size_t own_;    // how many of them are not coarse
    Imath::V2d extent_{1, 1};
    float cell_px_ = 0, far_cells_ = 0; // of the tile's coarse casters; 0: there are none
    struct AreaBlocks {
        std::size_t set, area;
        std::vector<std::uint32_t> blocks;
    };
    std::vector<AreaBlocks> by_area_; // those that can reach the tile
};

template <typename Visit>
bool ShadowSearch::in_blocks(const ShadowedLamp &lamp, std::size_t set, std::span<const std::uint32_t> blocks,
                             const CocRange &cocs, const Visit &visit) const {
    for (const std::uint32_t b : blocks) {
        const std::optional<CastingBlock> block = casting(lamp, set, b, cocs);
        if (block && !visit(*block)) return false;
    }
    return true;
}

template <typename Visit>
void ShadowSearch::in_tile(const ShadowedLamp &lamp, const Visit &visit) const {
    for (const auto &[set, area, blocks] : by_area_)
        if (const auto cocs = cocs_of(lamp, set, area); cocs && !in_blocks(lamp, set, blocks, *cocs, visit))
            return;
}

template <typename Visit>
void ShadowSearch::in_picture(const ShadowedLamp &lamp, const Visit &visit) const {
    for (std::size_t set = 0; set < casters_.size(); ++set) {
        const ShadowAreas &areas = casters_[set].footprints.areas();
        for (std::size_t area = 0; area < areas.count(); ++area)
            if (const auto cocs = cocs_of(lamp, set, area);
                cocs && !in_blocks(lamp, set, areas.blocks_of(area), *cocs, visit))
                return;
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

// Lists of what may cast shadows on wide discs, made once for all tiles of a picture: a disc reaches many tiles, and
// few of the blocks in front of it are near enough to its light's path.
class ShadowLists {
public:
    // Lists for groups of highlights among these samples.
    ShadowLists(const Highlights &highlights, const BlockedSamples &samples);

    // Returns the list of the group with this first member. The first call, by any thread, takes it from find(). Null:
    // the disc of the group is small, or the list is too long to be kept.
    template <typename Find>
    const std::vector<CastingBlock> *of(std::uint32_t first_member, const Find &find) const;

private:
    struct List {
        std::once_flag found;
        std::vector<CastingBlock> blocks;
        bool kept = false;
    };
    static constexpr std::uint32_t none = 0xffffffffu;
    // [highlight]: the number of its group's list if it is the first of the group; or none
    std::vector<std::uint32_t> number_;
    std::size_t longest_ = 0;
    mutable std::vector<List> lists_;
};

template <typename Find>
const std::vector<CastingBlock> *ShadowLists::of(std::uint32_t first_member, const Find &find) const {
    if (number_[first_member] == none) return nullptr;
    List &list = lists_[number_[first_member]];
    std::call_once(list.found, [&] {
        std::vector<CastingBlock> blocks = find();
        list.kept = blocks.size() <= longest_;
        if (list.kept) list.blocks = {blocks.begin(), blocks.end()}; // without spare capacity
    });
    return list.kept ? &list.blocks : nullptr;
}

} // namespace sparselens
