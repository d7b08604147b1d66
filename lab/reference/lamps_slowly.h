// Computes the light of highlights (dof/lens/highlights.h) slowly and simply: each of many points in every pixel looks
// at every lamp through the one lens point that leads there, past every sample. In double, from the formulas of
// design.md section 1; tests HighlightTile.
//
// A point q in the disc of a lamp at x with CoC c sees it through lens point u = (q - x) / c, if u is in the lens.
// Samples nearer than the lamp hide it there by their coverage, if they cover q as seen through u. A sample covers its
// unit square, displaced by its CoC. Beside a sample of a neighbouring pixel (the nearest in depth, less than three
// quarters of a pixel away in depth) it ends half-way to that sample, at the mean of both positions and CoCs, and up to
// a pixel in between (dof/footprints/footprint.h). Beside a sample that it is linked to (dof/facets/facets.h) it ends
// half-way however far that is. Lamps of partial coverage in different pixels do not hide each other if one is less
// than a tenth farther away. The light of a lamp whose CoC is below two pixels comes from a square around its position,
// one pixel wide for a CoC up to one and narrower for larger ones: every point of the lens sends it to the pixels that
// contain the square.
#pragma once

#include "deep/ldi.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// A sample of an LDI, and the part of its light that is spread.
struct SlowLamp {
    std::uint64_t sample;
    std::array<double, 3> light;
};

// The light of a pixel.
struct SlowlyLit {
    std::array<double, 3> light{};
    double unhidden = 0; // its R if nothing hid any lamp
};

// The pixels of the data window, row by row. `side` > 0: points per row and per column of a pixel. The lens is round,
// and there is no holdout.
std::vector<SlowlyLit> lamps_slowly(const Ldi &ldi, const ThinLens &lens, std::span<const SlowLamp> lamps,
                                    int side);

} // namespace sparselens
