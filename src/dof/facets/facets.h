// Facets: triangles that close surfaces so steep that their samples part as seen from some points of the lens.
//
// Two opaque samples of adjacent pixels whose perceptive depths differ by D move apart by D pixels towards the rim of
// the lens. What lies behind then shows between them, unless the surface is known to continue from one to the other. It
// does (the samples are linked) if |D| is less than steep_px, or if D is one of three steps of depth that follow each
// other in a row or a column and have the same sign. D may be the first, the second or the third of them. S is the
// smaller of the other two steps, for the choice with the largest S. Then
//   |D| < steep_px + 2 S
// links a slope to where it ends, and a curved slope to itself. A silhouette has no such steps: the surfaces in front
// of it and behind it are flatter than the step between them, and a pixel of mixed depth divides that into two steps. A
// sample has at most one link in each direction: to the sample nearest in depth.
//
// A facet is a triangle between three samples of the four pixels that meet in a corner. One of its samples lies in the
// upper left pixel, two of its sides are links, and some side is steep. Four samples that are linked all around form
// two facets, divided by the diagonal from the upper left. Seen through the lens, a facet extends the footprints of its
// samples: each of its points belongs to the sample that weighs most there (barycentric coordinates), unless the
// squares of its samples cover the facet (kernels/lens_rules.h).
#pragma once

#include "deep/ldi.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sparselens {

struct Facet {
    std::array<std::uint32_t, 3> sample; // indices into the LDI
};

// Facets in blocks of `size` by `size` pixels. A facet is in the block of the upper left of its four pixels.
struct FacetBlocks {
    static constexpr int size = 8;
    std::vector<std::vector<Facet>> blocks; // only those with facets, row by row
};

// `widest`: the largest distance of a lens point from the middle, in pixels per pixel of CoC. The LDI must have fewer
// than 2^32 samples.
FacetBlocks find_facets(const Ldi &ldi, const ThinLens &lens, double widest);

} // namespace sparselens
