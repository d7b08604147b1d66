// What hides highlights (highlights.h) in one tile.
//
// Whether a place in a disc sees the lamp needs no lens points of the gather: place and lamp fix the point of the lens, and
// so what hides the lamp there (lens/lamp_shadow.h). A sample hides all that is farther; those of one surface hide
// none of each other, as they end where the next begins (dof/footprints/footprint.h). Highlights of partial
// coverage in other pixels, no more than a tenth nearer, hide none of each other: they are lamps smaller than a pixel, side by
// side.
//
// The pixels of one lamp share the shadows that are nearly the same for all of them, so that a lamp costs no more where it has
// more pixels. Of two places of a lamp, w pixels apart, the shadows of one thing lie (1 - m) w apart, m as in lamp_shadow.h:
// less than w, if the thing is out of focus on the other side or half as much as the lamp at most. The members of a group
// (highlight_groups.h) take that shadow from the one in their middle, and it is off by a fiftieth of the disc's radius at most.
// What stands nearer to the lamp is cast for each of them.
//
// In a tile that is gathered in cells (cells.h) the shadows of what stands far before the lamp are those of the coarse scene's samples:
// that of a cell is no wider than a sixteenth of the disc's radius.
#pragma once

#include "dof/lens/block_footprints.h"
#include "dof/lens/highlights.h"
#include "dof/lens/sample_blocks.h"
#include "lens/lamp_shadow.h"
#include "lens/lamp_spread.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

// Where shadows are cast: a thing at x' of CoC c' lies there at middle + scale (x' - x) / (c - c').
struct ShadowScreen {
    Imath::V2d middle, scale;
    Imath::Box2i box;
    bool fine = false; // in cells of the lens, not in pixels
};

// What casts them: samples of the scene of the highlights, or of a coarse one.
struct ShadowCasters {
    const BlockedSamples &samples;
    const BlockFootprints &footprints;
    // Pixels that a cell of theirs is wide and high; and where their places begin, as pixels of the highlights' scene are counted.
    float across = 1;
    Imath::V2f corner = {0, 0};
    bool is_coarse() const { return across > 1; }
};

// Of a coarse scene, those that can reach a tile.
struct CoarseCasters {
    ShadowCasters samples, solids;
    std::span<const std::uint32_t> blocks, solid_blocks;
};

class HighlightShadows {
public:
    // `samples`: those that highlights are named by. `solids` (solid_samples.h) cast shadows as well.
    HighlightShadows(const Highlights &highlights, const ShadowCasters &samples, const ShadowCasters &solids)
        : highlights_(highlights), samples_(samples.samples), casters_{samples, solids} {}

    // Of the tile whose first pixel is `origin`, relative to the data window's corner. Then the blocks that can reach it.
    // `extent`: of the lens, for each pixel of CoC. `coarse`: for a tile that is gathered in cells.
    void begin(const Imath::V2i &origin, std::span<const std::uint32_t> samples,
               std::span<const std::uint32_t> solids, double pixel_aspect, const Imath::V2d &extent,
               const CoarseCasters *coarse = nullptr);

    // Highlights are named by their place in Highlights.
    // For a group: what its members share, in the pixels of a box. Only cast() for each tells the rest.
    void share(std::span<const std::uint32_t> group, const Imath::Box2i &box);

    // For one member of the group, on a screen of that box. False: nothing hides a part of it.
    bool cast(std::uint32_t highlight, const ShadowScreen &screen);

    // Whether all of the box is hidden from the whole group.
    bool dark() const { return shares_ && shared_.dark(); }

    // As LampShadow::lit().
    float lit(int x, int y, const LampDisc *disc = nullptr) const;

    // What cast() said, of a group of one.
    const LampShadow &own() const { return own_; }

    Lamp lamp(std::uint32_t highlight) const; // relative to the tile

private:
    // A lamp, or the middle one of a group.
    struct Asked {
        std::uint32_t sample;
        Lamp lamp;
        ShadowScreen screen;
        // What is hardly nearer moves hardly, and hides the lamp only if it lies right before it.
        float depth, hardly;
        float far; // perceptive depth, pixels: from which on coarse casters cast; infinite: there are none
        Imath::Box2f place; // of all
        double spread = 0;  // pixels: of the group around it

        bool is_beside(const Imath::Box2f &box) const {
            constexpr float beside = 2; // pixels
            return box.min.x < place.max.x + beside && box.max.x > place.min.x - beside &&
                   box.min.y < place.max.y + beside && box.max.y > place.min.y - beside;
        }
        float nearer_than(const SampleBlock &block) const {
            return is_beside({{block.x_min, block.y_min}, {block.x_max, block.y_max}}) ? depth : hardly;
        }
    };
    Imath::V2f place(std::uint32_t highlight) const; // relative to the data window's corner
    float far_before(float depth) const;
    std::uint32_t middle_of(std::span<const std::uint32_t> group) const;
    // Which of a set of casters cast the shadows: those whose perceptive depth, as they count it, lies between these.
    struct Range {
        float farthest, nearest;
    };
    Range range_of(const Asked &lamp, const ShadowCasters &casters) const;
    Range range_of(const Asked &lamp, const ShadowCasters &casters, const SampleBlock &block) const;
    struct Block { // of casters_[set]
        std::size_t set;
        std::uint32_t number;
    };
    void add_blocks(std::size_t set, std::span<const std::uint32_t> blocks);
    bool is_shared(const Asked &group, const Block &block) const;
    void cast_block(const Asked &lamp, const Block &block, LampShadow &shadow) const;
    void cast_one(const Asked &lamp, const ShadowCasters &casters, std::uint32_t sample,
                  const Footprint &footprint, std::uint32_t name, LampShadow &into) const;
    template <typename Visit>
    void for_each_block(const Asked &lamp, const Visit &visit) const;
    template <typename Bounds>
    bool is_before(const Asked &lamp, const ShadowCasters &casters, const Bounds &bounds) const;
    template <typename Bounds>
    bool can_shadow(const Asked &lamp, const ShadowCasters &casters, const Bounds &bounds) const;
    bool are_side_by_side(std::uint32_t lamp_sample, std::uint32_t sample) const;

    const Highlights &highlights_;
    const BlockedSamples &samples_;
    std::vector<ShadowCasters> casters_; // samples, solids; and those of the tile's coarse scene
    Imath::V2i origin_;
    double pixel_aspect_ = 1;
    Imath::V2d extent_{1, 1};
    float cell_px_ = 0; // of the tile's coarse scene; 0: there is none
    struct AreaBlocks {
        std::size_t set, area;
        std::vector<std::uint32_t> blocks;
    };
    std::vector<AreaBlocks> by_area_; // those that can reach the tile
    std::optional<Asked> group_;      // of several samples
    std::vector<Block> apart_;        // blocks that cast other shadows on each of its samples
    LampShadow shared_, own_;
    bool shares_ = false, has_own_ = false;
};

} // namespace sparselens
