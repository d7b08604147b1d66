// Whether the colours of a picture are light, or were encoded for a display (sRGB) and are read as light.
//
// A pixel on an edge shows a mixture of what lies on its two sides, and light mixes linearly: the colour lies on the line
// between theirs. Encoded, that line is a curve, by the transfer function of IEC 61966-2-1. For a colour between two others, the
// points on the line and on the curve are known, and a mixture lies beside one of them. The colour of a third surface may lie
// anywhere, so it does not count. Views of one sample mix nothing.
#pragma once

#include "../../view/view.h"

#include <cstddef>

namespace sparselens {

// Pixels between two sides, and how many of them lie around the point of the line, around that of the curve, and around one that
// lies as far beyond the curve, where only chance and noise bring them: nearer to it than half the way from line to curve.
struct EdgeMixing {
    std::size_t pixels = 0, light = 0, encoded = 0, beyond = 0;
};

EdgeMixing mixing_at_edges(const View &view);

// Whether the curve explains a tenth of the pixels or more, and more than the line and than chance, by three standard deviations.
// Greys, black and what is above 1 say nothing.
bool looks_encoded(const EdgeMixing &mixing);

} // namespace sparselens
