// Whether the colours of a picture are light, or were encoded for a display (sRGB) and are read as light.
//
// A pixel on an edge shows a mixture of what lies on its two sides, and light mixes linearly: the colour lies on the line
// between theirs. Encoded, that line is a curve, by the transfer function of IEC 61966-2-1. How far the pixel lies along
// that curve, off the line, is 0 for light and 1 for sRGB; noise takes it to either side.
#pragma once

#include "../../view/view.h"

#include <cstddef>

namespace sparselens {

struct EdgeMixing {
    std::size_t edges = 0; // pixels that tell
    double encoded = 0;    // their median: 0 for light, 1 for sRGB
};

EdgeMixing mixing_at_edges(const View &view);

// Of 33 rendered and traced pictures, the median lies from -0.13 to 0.04, and from 0.66 to 1.13 once they are encoded. False
// where too few pixels tell: greys, black and what is above 1 say nothing.
bool looks_encoded(const EdgeMixing &mixing);

} // namespace sparselens
