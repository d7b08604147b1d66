// A rolling shutter, which exposes the rows of a picture one after the other, from the top to the bottom.
//
// Its duration is the part of the shutter's whole time for which each row is exposed, from 0.001 to 1: the top edge of
// the display window is exposed in the first such part, its bottom edge in the last one. With 1, all rows are exposed
// together, for the whole time. Cycles has the same definition (rolling_shutter_duration).
#pragma once

#include "shutter/lens_share.h"
#include "shutter/shutter_curve.h"

#include <vector>

namespace sparselens {

inline constexpr double least_rolling_duration = 0.001;

// When a row is exposed. `row` counts from the top of the display window, which has `rows` rows. Rows beyond the window
// are exposed when its first or last row is.
ShutterPart exposure_of_row(int row, int rows, double duration);

// The weights of the moments in each row of the display window, [moment][row]. Each row's own exposure has the whole
// curve.
std::vector<std::vector<double>> row_weights(const ShutterCurve &curve, int moments, double duration,
                                             int rows);

// The share of the lens points that a moment takes: those moments that one row sees have all of them together.
LensShare share_of_moment(int moment, int moments, double duration);

} // namespace sparselens
