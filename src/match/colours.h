// The pictures that dof-match compares, tone-mapped (base/tone_map.h), so that noise and errors count everywhere as
// they do on a display.
#pragma once

#include "base/grid.h"

#include <array>
#include <utility>
#include <vector>

namespace sparselens {

// A grey picture: the brightness of a plate, in [0, 1), or a derivative.
struct Grey {
    Grid grid;
    std::vector<float> values; // [pixel]
};

// A gathered picture.
struct Colours {
    Grid grid;
    std::array<std::vector<float>, 3> rgb; // [channel][pixel]
};

// Blurs scene-linear colours by a Gaussian of this variance, square pixels, as a soft lens or film does. A negative
// variance, at least -0.4, sharpens. Pixels beyond the border repeat it.
Colours softened(const Colours &linear, double variance);

Colours tone_mapped(Colours linear);

// The mean of R, G and B of tone-mapped colours.
Grey brightness(const Colours &of);

Colours black(const Grid &grid);

// (a - b) / step.
Colours difference(Colours a, const Colours &b, double step);

// How a picture changes if it is blurred more along x than along y, and along the falling diagonal.
std::pair<Colours, Colours> motion_changes(const Colours &of);

} // namespace sparselens
