// The footprints of the samples of a picture, by blocks. The shadows on small lamps (highlight_tile.h) are computed
// from them. Bounds of blocks, and of areas of 8 x 8 blocks, tell at once which of them cast no shadow on a lamp.
#pragma once

#include "dof/footprints/footprint.h"
#include "dof/lens/sample_blocks.h"

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

namespace sparselens {

struct CocRange {
    float least, most; // pixels, signed
};

// Bounds of what may cast shadows.
struct CasterBounds {
    Imath::Box2f
        place; // of the centres of the samples; the edges of their footprints lie less than a pixel beyond it
    CocRange coc;               // of the edges
    CocRange focus;             // of the sums of CoC and disparity, which is the disparity of the focus
    float depth_min, depth_max; // disparity, pixels

    static CasterBounds none() {
        constexpr CocRange empty{INFINITY, -INFINITY};
        return {{}, empty, empty, INFINITY, -INFINITY};
    }
    void extend(const CasterBounds &by);
    // Returns the CoCs that edges between two disparities may have. The CoCs of two samples differ as their
    // disparities do, and the nearer one has the smaller CoC, except in a bent field.
    CocRange cocs_between(float farthest, float nearest) const {
        constexpr float rounding = 0.01f; // pixels
        return {std::max(coc.least, focus.least - nearest - rounding),
                std::min(coc.most, focus.most - farthest + rounding)};
    }
};
class BlockFootprints {
public:
    // `links`: of the LDI that the samples are from. Without them, samples that part are not joined.
    BlockFootprints(const Ldi &ldi, const BlockedSamples &samples, std::optional<Links> links = {});
    BlockFootprints(const BlockFootprints &) = delete; // its parts refer to each other

    struct DepthRange { // disparity
        float farthest, nearest;
    };
    struct Block {
        std::vector<JoinedFootprint> alone, joined; // footprints of its samples
        std::vector<DepthRange> joined_over;        // the ranges of depth of joined footprints, ascending
        std::vector<CasterBounds> near; // of the joined footprint that is nearest, of the nearest two, ...

        // Returns the joined footprints; the single ones if a joined one could lie on both sides of a lamp whose
        // disparity is between these.
        const std::vector<JoinedFootprint> &apart_from(float farthest, float nearest) const;
        // The bounds of the joined footprints with something nearer than a depth; null: there are none.
        const CasterBounds *nearer_than(float depth) const;
    };
    // Computed when first asked for, by any thread.
    const Block &of(std::uint32_t block) const;

    // Calls visit(block, bounds), until it returns false, for the blocks whose bounds and whose area's bounds pass.
    // Returns whether it never did.
    template <typename Pass, typename Visit>
    bool for_each(const Pass &pass, const Visit &visit) const {
        for (const Area &area : areas_) {
            if (!pass(area.bounds)) continue;
            for (const std::uint32_t b : area.blocks)
                if (pass(bounds_[b]) && !visit(b, bounds_[b])) return false;
        }
        return true;
    }

private:
    struct Area {
        CasterBounds bounds = CasterBounds::none();
        std::vector<std::uint32_t> blocks;
    };
    // Calls visit(block) for the blocks of a box of columns and rows.
    template <typename Visit>
    void for_blocks(const PositionBox &box, const Visit &visit) const {
        const int last_row = std::min(box.max.row, samples_.rows - 1),
                  last_column = std::min(box.max.column, samples_.columns - 1);
        for (int row = std::max(box.min.row, 0); row <= last_row; ++row)
            for (int column = std::max(box.min.column, 0); column <= last_column; ++column)
                visit(std::uint32_t(row * samples_.columns + column));
    }
    // Where a block lies among the blocks, and its pixels in the data window.
    Position at(std::uint32_t block) const {
        return ArrayGrid(samples_.columns, samples_.rows).position(block);
    }
    PositionBox pixels_of(std::uint32_t block) const {
        constexpr int size = BlockedSamples::size;
        const Position first(at(block).column * size, at(block).row * size);
        return {first, first + Imath::V2i(size - 1)};
    }
    CasterBounds bounds_of(std::uint32_t block) const;
    SamplesInPicture in_picture() const;
    std::vector<Footprint> compute(std::uint32_t block) const;

    const Ldi &ldi_;
    const BlockedSamples &samples_;
    std::optional<Links> links_;
    std::vector<CasterBounds> bounds_; // [block]
    std::vector<Area> areas_;
    mutable std::vector<std::once_flag> made_;
    mutable std::vector<Block> computed_;
};

} // namespace sparselens
