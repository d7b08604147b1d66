// Facets: surfaces that are so steep that their samples part before some point of the lens.
//
// Two opaque samples of pixels side by side whose perceptive depths differ by D move apart by D pixels towards the rim
// of the lens, and what lies behind shows between them, unless it is known that the surface goes on from one to the
// other. It does (the samples are linked) if |D| is less than steep_px, or if D is one of three steps of depth that
// follow each other in a row or a column and run the same way. With S the smaller of the other two (of the three places
// that D may have among them, the one of the largest S),
//   |D| < steep_px + 2 S
// links a slope to where it ends, and a curved slope to itself. A silhouette has no such steps: before it and behind it
// surfaces are flatter than the way from one to the other, and a pixel of mixed depth makes two steps of it. A sample has
// at most one link each way: to the nearest depth.
//
// A facet is a triangle between three samples of four pixels that meet in a corner, one of them in the upper left pixel, two of
// whose sides are links and of which some side is steep; four samples that links go around are two, parted from the upper left. Seen through the lens it extends the footprints of its samples: each of its points belongs to
// the sample that weighs most there (barycentric coordinates), unless the squares of its samples cover it
// (kernels/lens_rules.h).
#pragma once

#include "deep/ldi.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sparselens {

struct Facet {
    std::array<std::uint32_t, 3> sample; // of the LDI
};

// By blocks of `size` by `size` pixels: that of the upper left of the four pixels.
struct FacetBlocks {
    static constexpr int size = 8;
    std::vector<std::vector<Facet>> blocks; // those that have any, row by row
};

// `widest`: how far lens points are from the middle at most, in pixels for each pixel of CoC. The LDI has less than 2^32 samples.
FacetBlocks find_facets(const Ldi &ldi, const ThinLens &lens, double widest);

} // namespace sparselens
