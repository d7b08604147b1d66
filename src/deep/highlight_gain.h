// Makes lights brighter. Pictures whose light sources are clipped give dull discs, so colours above a threshold grow
// before the gather.
//
// A sample of luminance Y (Rec. 709 weights, without coverage) grows by 1 + (gain - 1) s((Y - threshold) / knee), where
// s(t) = t^2 (3 - 2 t) for t in [0, 1], 0 below and 1 above. Hue and coverage stay. The factor depends on the sample
// alone and has no step, so nothing flickers in a sequence; light is added, not conserved.
#pragma once

#include "../view/look_values.h"
#include "ldi.h"

#include <array>

namespace sparselens {

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
