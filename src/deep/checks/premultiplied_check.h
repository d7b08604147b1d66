// Whether the colours of a picture are multiplied by their coverage, as they must be.
//
// Over an edge of one to three pixels, from an opaque surface to nothing, coverage falls from 1 to 0. Premultiplied
// colours fall with it, while unpremultiplied ones stay as bright as the surface. Light that is added without coverage
// (glows, flames) cannot tell the two apart, so the pixels beyond the edge have to be black.
#pragma once

#include "../../view/flat_pixels.h"

#include <cstddef>

namespace sparselens {

struct EdgeFall {
    std::size_t pixels = 0; // on such edges
    double stays = 0; // median of how far they stay bright: 0 if colours fall with coverage, 1 if they do not
};

EdgeFall fall_at_edges(const FlatPixels &pixels);

bool looks_unpremultiplied(const EdgeFall &fall);

} // namespace sparselens
