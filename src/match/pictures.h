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

// A picture in colour.
struct Rgb {
    Grid grid;
    std::array<std::vector<float>, 3> rgb; // [channel][pixel]
};

// Blurs scene-linear colours by a Gaussian of this variance, square pixels, as a soft lens or film does. A negative
// variance, at least -0.4, sharpens. Pixels beyond the border repeat it.
Rgb softened(const Rgb &linear, double variance);

Rgb tone_mapped(Rgb linear);

// The mean of R, G and B of tone-mapped colours.
Grey brightness(const Rgb &of);

Rgb black(const Grid &grid);

// (a - b) / step.
Rgb difference(Rgb a, const Rgb &b, double step);

// How a picture changes if it is blurred more along x than along y, and along the falling diagonal.
std::pair<Rgb, Rgb> motion_changes(const Rgb &of);

} // namespace sparselens
