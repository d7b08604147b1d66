// Small bright lights, spread exactly.
//
// A lamp far out of focus is a smooth disc; a sum over lens points is that only if there are more of them than
// pixels in the disc. So the light of a sample that stands far above what surrounds it is taken out of it and
// spread by its point spread function (exact pixel areas) instead. Whether a pixel of the disc sees the lamp is
// decided as for all else, at the lens point: pixel and sample fix it, and the nearest one of the set answers. A lamp
// may be of partial coverage: one smaller than a pixel always is.
#pragma once

#include "dof/lens/sample_blocks.h"
#include "dof/lens/sample_colours.h"
#include "lens/aperture.h"
#include "lens/cat_eye.h"
#include "lens/lens_samples.h"

#include <Imath/ImathVec.h>

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

struct Highlights {
    std::vector<std::uint32_t> sample; // of the BlockedSamples, ascending
    SampleColours light;               // what each spreads; none in A
};

// The highlights of a picture; what they spread is taken out of `colours`. A sample is one if the brightest of its
// `brightness` channels is more than four times what 31 of 32 samples around it stay below, which bounds the cost,
// and if its CoC is at least two pixels. Of the channels only those in `colour_channels` are light.
Highlights take_highlights(const BlockedSamples &samples, std::span<const std::size_t> brightness,
                           std::span<const std::size_t> colour_channels, SampleColours &colours);

// Light of a highlight in one pixel of a tile, if the lens point `lens` sees it there.
struct HighlightPixel {
    std::uint32_t lens;
    std::uint8_t x, y;
    ColourSet of;            // the channels whose light it is
    std::uint32_t highlight; // index into Highlights
    float weight;            // of the PSF in the pixel
};

// Which lens point of a set is the nearest to a place on the lens, to within the width of a cell of a table.
class NearestLensPoint {
public:
    explicit NearestLensPoint(std::span<const LensSample> lens);
    std::uint32_t operator()(float x, float y) const; // as LensSample::x, y; beyond the rim: as at the rim

private:
    static constexpr int cells = 96;
    float scale_x_, scale_y_;
    std::vector<std::uint32_t> table_;
};

// What shapes their light. `corner`: of the data window that samples are relative to, EXR coordinates.
struct HighlightShape {
    const Aperture &aperture;
    const CatEye &cat_eye;
    Imath::V2i corner{0, 0};
};

// All pixels of the tile [origin, origin + size), of at most 256 pixels, that highlights reach, in the order of the lens points.
std::vector<HighlightPixel> highlight_pixels(const Highlights &highlights, const BlockedSamples &samples,
                                             const NearestLensPoint &nearest, const HighlightShape &shape,
                                             double pixel_aspect, const Imath::V2i &origin, int size);

} // namespace sparselens
