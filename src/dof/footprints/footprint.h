// What a sample covers in the picture that a lens point sees: a unit square, or up to where a neighbour of the same surface
// begins, so that samples that lie between pixels or move apart leave no cracks between them.
//
// Two samples of pixels beside each other, the nearest in depth to each other, are one surface if their perceptive depths
// differ by less than a pixel: then they move apart by less than a pixel too. They share an edge, which lies in the middle
// between them and moves with the mean of their CoCs. From 3/4 of a pixel on, each one's edge comes loose, until at a pixel it is
// that of its square, so that nothing tears at once as the aperture opens. Opaque samples of a surface so steep that more
// lies between them share their edge as well, where they are linked (dof/facets/facets.h).
#pragma once

#include "deep/ldi.h"
#include "dof/facets/links.h"
#include "kernels/lens_rules.h"

#include <Imath/ImathBox.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// The edges on the left, on the right, above and below.
struct Footprint {
    std::array<float, 4> place; // pixels, of x or of y, as the samples count them
    std::array<float, 4> coc;   // by which each is displaced
};

// Samples of an LDI where a lens sees them: of each its centre, its CoC and its perceptive depth, pixels, and which of the LDI
// it is; others than the LDI's are beyond its number of samples. They may be some of the LDI's alone.
struct SamplesInPicture {
    std::span<const float> x, y, coc;
    std::span<const std::uint32_t> upper; // of its key (kernels/lens_rules.h), which says the depth
    std::span<const std::uint32_t> source;
    const Links *links = nullptr; // between the LDI's opaque samples; null: none is
    float depth(std::size_t i) const { return kernels::depth_of(upper[i]); }
};

struct SampleRun {
    std::uint32_t begin, end;
};

// The footprints of the samples of `run`, which are all those of some pixels: columns and rows of the data window. `around`:
// where the samples of these pixels and of those beside them are.
std::vector<Footprint> footprints_of(const Ldi &ldi, const SamplesInPicture &samples,
                                     const Imath::Box2i &pixels, const SampleRun &run,
                                     std::span<const SampleRun> around);

// By how much the CoC of an edge may differ from that of its sample, pixels, in a box of pixels.
float coc_to_edges(const Links *links, const Imath::Box2i &pixels);

} // namespace sparselens
