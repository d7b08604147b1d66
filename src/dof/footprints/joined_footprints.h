// Opaque samples of one surface that lie side by side, as one rectangle: what is far away behind it sees no difference, and asks once
// instead of for each sample.
//
// Footprints are joined where they touch and their other edges go on straight: along a row of pixels, and then row upon row. A joined
// one covers all that they cover. Its edges lie no farther from theirs than a small part of a pixel, and so do its CoCs from theirs.
#pragma once

#include "dof/footprints/footprint.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

struct JoinedFootprint {
    Footprint footprint;
    float depth;          // perceptive, pixels: of the farthest sample
    float nearest;        // the same of the nearest one
    std::uint32_t sample; // the first one
};

// Joins the samples of a run, row by row, which have those footprints. Samples from `opaque_end` on are of partial coverage, and
// stay alone.
std::vector<JoinedFootprint> joined(const SamplesInPicture &samples, const SampleRun &run,
                                    std::uint32_t opaque_end, std::span<const Footprint> footprints);

} // namespace sparselens
