// Small bright lights, spread exactly.
//
// A lamp far out of focus is a smooth disc; a sum over lens points is that only if there are more of them than
// pixels in the disc. So the light of a sample that stands far above what surrounds it is taken out of it and
// spread by its point spread function (exact pixel areas) instead: highlight_tile.h. A lamp may be of partial coverage:
// one smaller than a pixel always is.
#pragma once

#include "dof/lens/highlight_groups.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/sample_colours.h"

#include <Imath/ImathBox.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

struct Highlights {
    std::vector<std::uint32_t> sample; // of the BlockedSamples, ascending
    std::vector<float> share;          // of its light that each spreads, (0, 1]
    SampleColours light;               // what each spreads; none in A
    HighlightGroups groups;            // of those samples
};

// The highlights of a picture; what they spread is taken out of `colours`. A sample is one if the brightest of its
// `brightness` channels is more than four times what four of five samples around it stay below, which bounds the cost. "Around"
// is the darkest of four windows of 64 x 64 pixels that overlap there: of what each shows in `seen` (pixels relative to the data
// window's corner) or lets light through, as what else lies beyond is made up; but of all that it shows where that is nothing.
// What is made up has to stand out of all that it shows, too, so that no more than a fifth of that are highlights.
// From six times on it spreads all that stands out, below that less and less, so that nothing pops where a lamp is hardly one.
// Only the channels in `colour_channels` are light.
Highlights take_highlights(const BlockedSamples &samples, std::span<const std::size_t> brightness,
                           std::span<const std::size_t> colour_channels, SampleColours &colours,
                           const std::optional<Imath::Box2i> &seen = {});

} // namespace sparselens
