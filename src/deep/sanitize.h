// Values that no picture can mean, made harmless where samples enter, so that a bad pixel stays one pixel. Nothing
// behind this place looks for them again: kernels may take every value for good.
//
//   colour that is not finite,    coverage times the mean colour of the pixels around it, by coverage
//       or beyond 1e34: sums of
//       it would overflow
//   A that is not a number        the mean of the pixels around it
//   A outside 0..1                clamped (and so AR, AG, AB, see channel_alpha.h)
//   depth NaN or negative         that of a pixel around it (the median), infinity where none has a good one
//   depth 0, or so small that     infinity: nothing was hit
//       1 / z is no float
//   place outside its pixel       at its edge; NaN: in the middle
//   weight not a number above 0   1
//
// Kept as they are: colours below 0, all other radiance, every other depth up to infinity; where A is 0 the
// depth is infinity whatever it was. "Around" are the eight neighbours; in a deep picture their samples nearest in
// depth.
#pragma once

#include "../view/view.h"
#include "ldi.h"

#include <cstddef>
#include <string>

namespace sparselens {

// How many there were. An A that rounding or a filter has put out of its range by less than 1/64 is not counted.
struct InvalidValues {
    std::size_t colours = 0, alphas = 0, depths = 0, places = 0;

    bool any() const { return colours + alphas + depths + places > 0; }
    std::string text() const; // "2 colours that are not finite, 1 depth that is no number above 0: ..."
};

// Depths are planar by now; samples need not be tidy. Error, naming `name` and the first such pixel, where half of
// what is covered or more has no depth above 0: that is no accident but another convention of depth.
InvalidValues sanitize(Ldi &ldi, const std::string &name);
InvalidValues sanitize(View &view);

} // namespace sparselens
