// Small bright lights, spread exactly.
//
// A lamp far out of focus is a smooth disc. A sum over lens points gives such a disc only with more lens points than
// the disc has pixels. So the light of a sample that stands out far above its surroundings is taken out of the sample
// and spread by its point spread function (exact pixel areas) instead: highlight_tile.h. A lamp may have partial
// coverage; a lamp smaller than a pixel always has.
#pragma once

#include "dof/lens/highlight_groups.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/sample_colours.h"
#include "shutter/lamp_paths.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

struct Highlights {
    std::vector<std::uint32_t> sample; // indices into the BlockedSamples, ascending; several may be the same
    std::vector<Imath::V2f> moved;     // how far the light is from its sample, pixels; empty: none is moved
    std::vector<float> share;          // share of its light that each spreads, (0, 1]
    SampleColours light;               // what each spreads; none in A
    HighlightGroups groups;            // of those samples

    PlacedHighlights among(const BlockedSamples &samples) const { return {samples, sample, moved}; }
};

// Finds the highlights of a picture, and takes the light that they spread out of `colours`. A sample is a highlight if
// the brightest of its `brightness` channels is more than four times a level. Four fifths of the samples around it, which
// count by what they cover, stay below this level. So at most a fifth are highlights, which bounds the cost. The level is
// that of the darkest of four windows of 64 x 64 pixels that overlap at the sample. A window counts the samples in `seen`
// (pixels relative to the data window's corner), and pixels beyond that let light through, because what else lies beyond
// is made up; if it has none of these, it counts all its samples. A made-up sample must stand out of all samples of its
// windows, too, so that at most a fifth of these are highlights.
// From six times the level on, a sample spreads all light that stands out; below, less and less, so that nothing pops
// where a lamp is hardly one. Only the channels in `colour_channels` are light.
Highlights take_highlights(const BlockedSamples &samples, std::span<const std::size_t> brightness,
                           std::span<const std::size_t> colour_channels, SampleColours &colours,
                           const std::optional<Imath::Box2i> &seen = {});

// The highlights as parts of lamps. `corner`: of the data window, EXR coordinates.
std::vector<LampPart> lamp_parts(const Highlights &highlights, const BlockedSamples &samples,
                                 std::span<const std::size_t> brightness, const Imath::V2i &corner);

// Spreads the light of highlights that move along their paths: each becomes several highlights, whose discs overlap.
void spread_along(const LampPaths &paths, const BlockedSamples &samples, const Imath::V2i &corner,
                  Highlights &highlights);

} // namespace sparselens
