// Gives the samples of a deep picture the colours of a flat picture of the same frame: studios keep deep alpha, and one
// flat beauty with its passes. After flattening, every channel of light equals the flat picture's again.
//
// In each pixel V is a channel of the flat picture and F its coverage; D is the coverage of all samples together, and a
// the coverage of one:
//
//   F agrees with D      each sample becomes V a / D, so that all flatten to V. D stays as it is
//   F is more            the rest of the coverage, (F - D) / (1 - D), becomes a sample at infinity behind the others,
//                        for a sky that the deep picture left out; all of them share V as above, with F in place of D
//   F is less            V a / D: the light is right, and the coverage stays
//   there is no sample   light becomes a sample at infinity with coverage F, which is 0 if the light covers nothing
//   nothing covers       the last sample gets all light
//
// If the deep picture has AR, AG and AB, they share the light that they cover, and A shares the rest. Samples behind an
// opaque one get its colour. Depths, volumes, coverage, ids, Cryptomattes and data come from the deep picture, all
// light from the flat one. A flat picture without A has the coverage of the deep one. The result has the pixels of the
// flat picture only.
#pragma once

#include "../looks/table.h"
#include "ldi.h"

#include <array>

namespace sparselens {

struct Recolored {
    Ldi ldi;
    std::size_t differ = 0;   // pixels whose coverage does not agree (base/light.h)
    std::size_t beyond = 0;   // pixels with samples outside the flat picture, which are left out
    std::size_t infinite = 0; // pixels that got a sample at infinity
};

// The values of both must be valid (sanitize.h), and the display windows the same.
Recolored recolor(Ldi ldi, const Image &flat);

// Whether recolor() takes the channel from the flat picture: every channel of light except coverage.
bool is_recolored(std::span<const Channel> channels, std::size_t k);

// Makes lights brighter. Pictures whose light sources are clipped give dull discs, so colours above a threshold grow
// before the gather.
//
// A sample of luminance Y (Rec. 709 weights, without coverage) grows by 1 + (gain - 1) s((Y - threshold) / knee), where
// s(t) = t^2 (3 - 2 t) for t in [0, 1], 0 below and 1 above. Hue and coverage stay. The factor depends on the sample
// alone and has no step, so nothing flickers in a sequence; light is added, not conserved.
struct HighlightGain {
    double gain = 1;      // [1, 1000]; 1 changes nothing
    double threshold = 1; // scene-linear luminance where growth begins, >= 0
    double knee = 1;      // luminance over which the gain sets in, > 0
};

// Reads the gain from the values of a look.
HighlightGain highlight_gain(const LookValues &values);

// The factor by which a sample of this luminance grows, >= 1.
double highlight_factor(const HighlightGain &by, double luminance);

// The factor for R, G and B with this coverage. Light without coverage, as in a glow, is taken as it is.
double highlight_factor(const HighlightGain &by, const std::array<double, 3> &rgb, double coverage);

// Multiplies R, G and B. An LDI that lacks one of them stays as it is.
void raise_highlights(Ldi &ldi, const HighlightGain &by);

} // namespace sparselens
