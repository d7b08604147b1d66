// Which objects the two surfaces of a mixed pixel show (base/matte.h).
//
// The pairs of the pixel itself say what is in it. Of each object the surface in front, which covers a share of the pixel,
// has what its colour is made of, but no more than the pixel has of it, and in all its share; the surface behind has the
// rest. What no object of the matte covers counts as an object. So coverages add up to the surfaces', and flattened they
// are the pixel's again.
#pragma once

#include "base/matte.h"
#include "deep/view_samples.h"

namespace sparselens {

// The last two samples of `out` are the two surfaces of that sample of the view, which is opaque; the one in front is made
// of these terms, and covers `share`, above 0 and below 1. Sets their pairs.
void share_mattes(const ViewSamples &view, std::uint64_t sample, std::span<const Term> front, double share,
                  std::span<const Matte> mattes, Ldi &out);

} // namespace sparselens
