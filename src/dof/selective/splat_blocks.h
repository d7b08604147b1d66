// The splats of an LDI in the order in which a gather needs them: cut into blocks, one per bin of depth in a square of
// pixels, sorted front to back. The bounds of a block (its position and reach) let a tile accept or reject it as a
// whole, so that a single huge circle of confusion costs only its own block.
#pragma once

#include "dof/selective/splats.h"

#include <Imath/ImathBox.h>

#include <span>
#include <vector>

namespace sparselens {

struct SplatBlock {
    int bin = 0;
    std::size_t begin = 0, end = 0; // splats
    Imath::Box2d centres, reach;    // of the splats' centres; of all pixels that they can touch
    double smallest = 0;            // the smallest radius of a CoC
};

struct SplatBlocks {
    // One entry per splat, block by block.
    std::vector<double> x, y, radius;
    std::vector<float> values;         // [splat][size()]: coverage, known, colours, known * radius
    std::size_t colours = 0, bins = 0; // their numbers

    std::vector<SplatBlock> blocks; // ascending bins, then squares of pixels
    // [block][size()]: values / area of the PSF in pixels, where the block can cover a tile
    std::vector<double> sums;

    std::size_t size() const { return sums_before_colours + colours + 1; }
    std::span<const float> value(std::size_t splat) const {
        return std::span(values).subspan(splat * size(), size());
    }
};

SplatBlocks make_splat_blocks(const SplatSource &source);

} // namespace sparselens
