// Joins the footprints of opaque samples of one surface that lie side by side into one rectangle. For a lamp far behind
// them the rectangle makes no difference, and it is tested once instead of once for each sample.
//
// Footprints are joined where they touch and their other edges go on straight: first along a row of pixels, then row by
// row. A joined footprint covers all that its parts cover. Its edges, and the CoCs of its edges, differ from the parts'
// by at most a small part of a pixel.
#pragma once

#include "dof/footprints/footprint.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

struct JoinedFootprint {
    Footprint footprint;
    float depth;          // perceptive depth of the farthest sample, pixels
    float nearest;        // the same of the nearest sample
    std::uint32_t sample; // the first of the joined samples
};

// Joins the samples of a run, row by row. `footprints`: the footprints of these samples. Samples from `opaque_end` on
// have partial coverage and stay alone.
std::vector<JoinedFootprint> joined(const SamplesInPicture &samples, const SampleRun &run,
                                    std::uint32_t opaque_end, std::span<const Footprint> footprints);

} // namespace sparselens
