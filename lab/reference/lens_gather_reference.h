// The lens gather, slow and obvious: every lens point of every pixel tries every sample, in long double, from the
// formulas of design.md section 1, with none of this library's kernels. Tests the fast one.
//
// A lens point looks through one point of the pixel. It sees the samples whose unit square, displaced by their
// CoC, covers that point, and those at the corner that weighs most there (barycentric coordinates) of a facet
// (facets.h) whose corners, displaced, lie around that point and are more than parted_px apart in x or in y. It
// sees them front to back: coverage is taken for independent, and the first opaque one ends it.
// Inside `window` a pixel that lets light through to infinity has an opaque, colourless, transparent background
// there, and another one that moves with its last sample, behind everything. Coverage of 0.9995 or more is full, and a
// pixel of which less than 1/2048 is left lets no light through: such differences are what rounding to halves makes.
//
// An opaque sample of a mirror or of glass (Ldi::optical) is met where its surface is. What it shows there is the colour of
// such samples displaced by the CoC of their images: of those that cover the place, the one with the nearest image, if its
// surface lies within one pixel of perceptive depth; else the same in the pixel to the left, to the right, above or below; else
// its own. Partial ones are displaced by the CoC of their images altogether.
//
// Behind a sample of Ldi::solid s lies a solid at 1 / z - s, opaque: a lens point that meets something opaque sees it instead where
// it covers the point and that lies farther than 1 / z - 2 s. It shows what solid_samples.h says.
//
// A lens point that meets nothing opaque in a pixel looks at what it meets in the pixels beside it, to the left and to
// the right, above and below, and in the corners:
// - two samples on opposite sides, less than 1.5 pixels apart in x and in y and one_surface_px in depth, are a surface
//   torn by parallax: it sees the farther of them (of several such pairs, the farthest; where they are as far, the first);
// - else it sees the nearest filler (fillers.h), unless what lies on either side is nearer than that by more than
//   one_surface_px: a gap so narrow may as well be a crack;
// - else it does not know what lies there: it counts by what it does know, which is the coverage that it met.
//
// A lens point that meets something opaque sees such a torn surface instead, where both samples are more than a pixel in depth
// nearer.
//
// What it meets, light and coverage, counts by the weight that the lens point has for the channel (R, G and B, by the last
// part of the name) and, but for data, for what lies behind focus or in front; backgrounds lie behind. Past a cat-eye a pixel sees by the lens
// points that it lets through alone. Where that darkens, R, G and B are the mean over lens points, not over their weights,
// times the share of the lens that it leaves (CatEye::share, evenly).
#pragma once

#include "base/image.h"
#include "deep/holdout.h"
#include "deep/ldi.h"
#include "lens/cat_eye.h"
#include "lens/lens_samples.h"
#include "lens/thin_lens.h"

#include <span>
#include <vector>

namespace sparselens {

// What a channel of a pixel is, and between which values any right answer lies: where the edge of a sample passes a
// lens point closer than float arithmetic can tell, rounding decides whether the point sees it, and both are right.
struct ReferenceValue {
    long double value = 0;
    long double least = 0, most = 0; // exact extremes of the light; where coverage varies too, bounds of them

    long double off(float other) const; // how far it lies outside; infinite if it is no number
};

struct ReferencePicture {
    Windows windows;
    std::vector<ReferenceValue> values; // [channel][pixel]
    std::vector<bool> sure;             // [pixel]: no edge of a sample is that close; least == most == value

    const ReferenceValue &at(std::size_t channel, int x, int y) const {
        return values[channel * windows.pixels() + windows.index(x, y)];
    }
    double unsure_share() const; // of the pixels
    double unsure_points = 0;    // the share, of all lens points of all pixels, that may see something else
};

// As lens_gather, with these lens points everywhere, without highlights and sharpening. Ids are the
// front samples'. The flattened LDI where no lens point sees anything.
ReferencePicture lens_gather_reference(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                                       std::span<const LensSample> points, const Holdout *holdout = nullptr,
                                       const CatEye *cat_eye = nullptr);

} // namespace sparselens
