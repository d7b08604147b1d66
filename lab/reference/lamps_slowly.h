// The light of highlights (dof/lens/highlights.h), slow and obvious: every one of many places in every pixel looks at every
// lamp through the one lens point that leads there, past every sample. In double, from the formulas of design.md section 1;
// tests HighlightTile.
//
// A place q in the disc of a lamp at x, of CoC c, sees it through u = (q - x) / c, if that lies in the lens. What is nearer than
// the lamp hides it there by its coverage, if it covers q as seen through u. What it
// covers is its unit square displaced by its CoC; beside a sample of a neighbouring pixel, of those the nearest in depth, less than
// three quarters of a pixel away in that, it ends half-way to it, at the mean of both places and CoCs, and up to a pixel in between
// (dof/footprints/footprint.h); beside one that it is linked to (dof/facets/facets.h) it ends half-way however far that is. Lamps of partial coverage hide none of each other
// in other pixels that are less than a tenth farther away. The light of a lamp whose CoC is below two
// pixels comes from a square around its place, of a pixel up to one and narrower in between: there every place in the lens sends
// it to the pixels that the square lies in.
#pragma once

#include "deep/ldi.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// A sample of an LDI, and what of its light is spread.
struct SlowLamp {
    std::uint64_t sample;
    std::array<double, 3> light;
};

// How a pixel is lit.
struct SlowlyLit {
    std::array<double, 3> light{};
    double unhidden = 0; // R of it, if nothing hid any lamp
};

// The pixels of the data window, row by row. `side`, > 0: each has so many places in a row and in a column. The lens is round, nothing is held out.
std::vector<SlowlyLit> lamps_slowly(const Ldi &ldi, const ThinLens &lens, std::span<const SlowLamp> lamps,
                                    int side);

} // namespace sparselens
