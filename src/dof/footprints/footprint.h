// The area that a sample covers in the picture that a lens point sees: a unit square, or up to where a neighbour on the
// same surface begins, so that samples that lie between pixels or move apart leave no cracks between them.
//
// Two samples of adjacent pixels, the nearest in depth to each other, are one surface if their disparities differ
// by less than a pixel; they then move apart by less than a pixel, too. They share an edge, which lies in the middle
// between them and moves with the mean of their CoCs. From a difference of 3/4 of a pixel on, each sample's edge leaves
// the shared one; at one pixel it is the edge of the sample's own square. So nothing tears suddenly as the aperture
// opens. Opaque samples of a steeper surface also share their edge if they are linked (dof/facets/facets.h).
#pragma once

#include "deep/ldi.h"
#include "dof/facets/facets.h"
#include "kernels/lens_rules.h"

#include <Imath/ImathBox.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// The edges on the left, on the right, above and below.
struct Footprint {
    std::array<float, 4> place; // pixels, x or y, in the coordinates of the samples
    std::array<float, 4> coc;   // pixels: the CoC that displaces each edge
};

// Samples of an LDI, or some of them, where a lens sees them: their centres, CoCs and disparities, in pixels, and
// their indices in the LDI. An index beyond the LDI's samples marks a sample that is not the LDI's.
struct SamplesInPicture {
    std::span<const float> x, y, coc;
    std::span<const std::uint32_t> upper; // half of its key (kernels/lens_rules.h), which holds the depth
    std::span<const std::uint32_t> source;
    const Links *links = nullptr; // between the LDI's opaque samples; null: there are none
    float depth(std::size_t i) const { return kernels::depth_of(upper[i]); }
};

struct SampleRun {
    std::uint32_t begin, end;
};

// Returns the footprints of the samples of `run`, which are all samples of `pixels`. `around`: the runs with the samples of these pixels and of the pixels beside them.
std::vector<Footprint> footprints_of(const Ldi &ldi, const SamplesInPicture &samples,
                                     const PositionBox &pixels, const SampleRun &run,
                                     std::span<const SampleRun> around);

// Returns by how much, in pixels, the CoC of an edge may differ from the CoC of its sample in a box of pixels.
float coc_to_edges(const Links *links, const PositionBox &pixels);

// Joins the footprints of opaque samples of one surface that lie side by side into one rectangle. For a lamp far behind
// them the rectangle makes no difference, and it is tested once instead of once for each sample.
//
// Footprints are joined where they touch and their other edges go on straight: first along a row of pixels, then row by
// row. A joined footprint covers all that its parts cover. Its edges, and the CoCs of its edges, differ from the parts'
// by at most a small part of a pixel.
struct JoinedFootprint {
    Footprint footprint;
    float depth;          // disparity of the farthest sample, pixels
    float nearest;        // the same of the nearest sample
    std::uint32_t sample; // the first of the joined samples
};

// Joins the samples of a run, row by row. `footprints`: the footprints of these samples. Samples from `opaque_end` on
// have partial coverage and stay alone.
std::vector<JoinedFootprint> joined(const SamplesInPicture &samples, const SampleRun &run,
                                    std::uint32_t opaque_end, std::span<const Footprint> footprints);

} // namespace sparselens
