// Corrects the depth of pixels on the edge of a surface, where the renderer wrote a depth at which the pixel shows
// nothing.
//
// A renderer takes the depth of such a pixel from one of its samples, or filters it like a colour:
//
//   - The pixel is partly covered (0 < A < 1), and its depth is that of the nothing beside the surface: it is infinite,
//     or more than 16 times the depth of each more covered pixel around it. Or the pixel lies beside one that shows
//     nothing, and its depth is A times the depth of a pixel around it, the mean of a surface and of zeros. The depth
//     is replaced by that of the pixel around it that explains it best: its colour without coverage is similar, and it
//     is well covered. "Around" means the eight neighbours, or if they do not help the 24 within two pixels. A strand
//     over nothing, thinner than a pixel, shows its depth in few pixels; they pass it on, up to 8 pixels farther.
//   - The pixel is opaque, and its depth and its colour mix two pixels on opposite sides in the same proportion, at a
//     step and not on a slope. It takes the depth of the surface that it shows more of. This is done only in a picture
//     with many such edges, because then its depth is filtered. In other pictures such edges are chance.
//
// Colour and coverage stay, so that what lies behind a partly covered pixel shows.
#pragma once

#include "deep/ldi.h"
#include "view/view.h"

#include <cstddef>
#include <string>

namespace sparselens {

struct SettledEdges {
    std::size_t count = 0; // depths that were replaced
    bool filtered = false; // opaque pixels among them: the depth is filtered like a colour
};

// Depths are planar, > 0 up to inf; colours are premultiplied, and all values valid (see
// sanitize.h). An Ldi must have one sample in each pixel.
SettledEdges settle_edge_depths(View &view);
SettledEdges settle_edge_depths(Ldi &ldi);

// The note of a reader about replaced depths.
std::string edge_note(std::size_t settled);

} // namespace sparselens
