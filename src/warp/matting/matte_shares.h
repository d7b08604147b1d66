// Decides which objects the two surfaces of a mixed pixel show (base/matte.h).
//
// The pairs of the pixel itself say which objects it shows. The surface in front covers a share of the pixel. It takes
// as much of each object as the samples that its colour is made of have, but no more than the pixel has, and its share
// in total; the surface behind has the rest. What no object of the matte covers counts as an object. So the coverages
// add up to the surfaces' coverages, and flattened they are the pixel's again.
#pragma once

#include "base/matte.h"
#include "deep/view_samples.h"

namespace sparselens {

// Sets the pairs of the last two samples of `out`, which are the two surfaces of a sample of the view. The surface in
// front hides the other one in its `share` of the pixel, above 0 and below 1. It is made of the terms `front`.
void share_mattes(const ViewSamples &view, std::uint64_t sample, std::span<const Term> front, double share,
                  std::span<const Matte> mattes, Ldi &out);

} // namespace sparselens
