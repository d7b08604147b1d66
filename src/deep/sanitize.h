// Replaces invalid values where samples are read, so that a bad pixel stays a single pixel. No code after this checks
// again: kernels may assume that every value is valid.
//
//   colour that is not finite,    coverage times the mean colour of the pixels around it, by coverage
//       or beyond 1e34: sums of
//       it would overflow
//   A that is not a number        the mean of the pixels around it
//   A outside 0..1                clamped (and so AR, AG, AB, see channel_alpha.h)
//   depth NaN or negative         the median of the pixels around it, or infinity where none is valid
//   depth 0, or so small that     infinity: nothing was hit
//       1 / z overflows a float
//   position outside its pixel    on its edge; NaN: in the middle
//   weight not a number above 0   1
//
// Colours below 0, all other radiance and every other depth up to infinity are kept. Where A and all light are 0 the
// depth becomes infinity. "Around" are the eight neighbours; in a deep picture, their samples that are nearest in depth.
#pragma once

#include "../base/image.h"
#include "../view/view.h"
#include "ldi.h"

#include <cstddef>
#include <string>

namespace sparselens {

// The numbers of invalid values. An A that is outside its range by less than 1/64, from rounding or a filter, does not
// count.
struct InvalidValues {
    std::size_t colours = 0, alphas = 0, depths = 0, places = 0;

    bool any() const { return colours + alphas + depths + places > 0; }
    std::string text() const; // "2 colours that are not finite, 1 depth that is not above 0: ..."
};

// The depths must be planar; the samples need not be tidy. Throws Error, naming `name` and the first such pixel, if
// half of the covered samples or more have a negative depth or NaN, because that indicates another convention.
InvalidValues sanitize(Ldi &ldi, const std::string &name);
InvalidValues sanitize(View &view);

// Multiplies colours by their coverage, if a file has them unpremultiplied ("straight").

// Multiplies every channel of light except coverage, by the A of its layer if the layer has one, otherwise by the
// channel's coverage (channel_alpha.h). A channel without coverage stays as it is.
void premultiply(Image &image);
void premultiply(Ldi &ldi);

} // namespace sparselens
