// Whether the colours of a picture were encoded for a display (sRGB) but are read as linear light.
//
// A pixel on an edge mixes the surfaces on its two sides, and light mixes linearly: its colour lies on the line between
// their colours. In encoded pictures the line becomes a curve, by the transfer function of IEC 61966-2-1. For a colour
// between two others, the points on the line and on the curve are known, and a mixture lies beside one of them. The
// colour of a third surface may lie anywhere, so it does not count. Views of one sample per pixel mix nothing.
#pragma once

#include "../../view/view.h"

#include <cstddef>

namespace sparselens {

// Counts of pixels between two sides: all; those near the point on the line; those near the point on the curve; and
// those near a point as far beyond the curve, which only chance and noise reach. "Near" is less than half the way from
// line to curve.
struct EdgeMixing {
    std::size_t pixels = 0, light = 0, encoded = 0, beyond = 0;
};

EdgeMixing mixing_at_edges(const View &view);

// Whether the curve explains a tenth of the pixels or more, and exceeds the line and chance by three standard
// deviations. Greys, black and colours above 1 are not counted.
bool looks_encoded(const EdgeMixing &mixing);

} // namespace sparselens
