// The lens gather, slow and simple: every lens point of every pixel tests every sample, in long double, from the
// formulas of design.md section 1, without this library's kernels. Tests the fast gather.
//
// A lens point looks through one point of the pixel. It sees the samples whose unit square, displaced by their CoC,
// covers that point. Positions, CoCs, displacements and the point in the pixel are rounded to 1/128 of a pixel, and lens
// points to 1/32768; if 16 bits cannot hold where the largest CoC moves samples, to 1/64, and so on. Depths are rounded, too:
// a word of 31 bits has a code of the depth above the number of the sample.
// It also sees samples through facets (facets.h): a facet counts if its displaced corners surround
// the point and are more than parted_px apart in x or in y, and shows the corner with the largest weight there
// (barycentric coordinates). Samples are seen front to back: coverages are independent, and the first opaque sample
// ends the view. Inside `window`, a pixel that lets light through to infinity has an opaque, colourless, transparent
// background there, and another background that moves with its last sample, behind everything. Coverage of 0.9995 or
// more is full, and a pixel that passes less than 1/2048 passes no light: rounding to halves makes such differences.
//
// An opaque sample of a mirror or of glass (Ldi::image_z) is met at its surface. The colour that it shows there comes
// from such samples displaced by the CoC of their images: from the one with the nearest image among those that cover
// the point, if its surface is within one pixel of disparity; else the same in the pixel to the left, to the
// right, above or below; else its own. Partial samples are simply displaced by the CoC of their images.
//
// Behind a sample with Ldi::solid s there is an opaque solid at 1 / z - s. A lens point that meets something opaque
// farther than 1 / z - 2 s sees the solid instead, if the solid covers the point. fillers.h says what the solid shows.
//
// If a lens point meets nothing opaque in a pixel, it looks at the neighbouring pixels, to the left and to the right,
// above and below, and in the corners:
// - two samples on opposite sides, less than 1.5 pixels apart in x and in y and one_surface_px in depth, are a surface
//   torn by parallax: the lens point sees the farther of them (of several such pairs, the farthest; of equally far
//   ones, the first);
// - else it sees the nearest filler (fillers.h), unless the samples on both sides are nearer than the filler by more
//   than one_surface_px: such a narrow gap may also be a crack;
// - else it does not know what is there, and only the coverage that it met counts.
//
// A lens point that meets something opaque sees such a torn surface instead, if both of its samples are nearer by more
// than a pixel in depth.
//
// Light and coverage count by the weight that the lens point has for the channel (R, G and B, by the last part of the
// name) and, except for data, for things behind focus or in front of it; backgrounds are behind. With a cat-eye, a
// pixel sees only through the lens points that the cat-eye passes. With darkening, R, G and B are the mean over all
// lens points, not over their weights, times the share of the lens that remains (CatEye::share, evenly).
#pragma once

#include "base/image.h"
#include "deep/ldi.h"
#include "deep/merge.h"
#include "lens/cat_eye.h"
#include "lens/lens_samples.h"
#include "lens/thin_lens.h"

#include <span>
#include <vector>

namespace sparselens {

// The value of a pixel's channel, and the range of correct answers: if the edge of a sample passes a lens point closer
// than float arithmetic can resolve, rounding decides whether the point sees it, and both answers are correct.
struct ReferenceValue {
    long double value = 0;
    long double least = 0, most = 0; // exact extremes of the light; bounds if coverage varies too

    long double off(float other) const; // distance outside the range; infinite if not a number
};

struct ReferencePicture {
    Windows windows;
    std::vector<ReferenceValue> values; // [channel][pixel]
    std::vector<bool> sure;             // [pixel]: no edge of a sample is so close; least == most == value

    const ReferenceValue &at(std::size_t channel, int x, int y) const {
        return values[channel * windows.pixels() + windows.index(Imath::V2i(x, y))];
    }
    double unsure_share() const; // of all pixels
    double unsure_points = 0;    // the share of all lens points of all pixels for which rounding decides
};

// As lens_gather, with these lens points everywhere, without highlights and sharpening. Ids come from the front
// samples. The flattened LDI where no lens point sees anything.
ReferencePicture lens_gather_reference(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                                       std::span<const LensSample> points, const Holdout *holdout = nullptr,
                                       const CatEye *cat_eye = nullptr);

} // namespace sparselens
