// How much light a shutter passes while it is open, and what each of its moments counts, in each row if it rolls.
#pragma once

#include "shutter/lens_share.h"

#include <vector>

namespace sparselens {

// Linear between its points, whose times ascend from 0, when the shutter opens, to 1, when it closes. Values are at
// least 0, in any unit.
struct ShutterCurve {
    struct Point {
        double time, value;
    };
    std::vector<Point> points;
};

ShutterCurve box_shutter();
ShutterCurve triangle_shutter();
// Centred, with a standard deviation of a sixth of the shutter's time.
ShutterCurve gaussian_shutter();

// A part of the shutter's time.
struct ShutterPart {
    double from = 0, to = 1; // 0 <= from < to <= 1
};

// The weight of each of `moments` (at least 1) equal parts of the shutter's time, in the middle of which a moment
// stands, if light falls in during `open`: the integral of the curve, which is squeezed into `open`, over the moment's
// part, in units of the length of the latter.
std::vector<double> moment_weights(const ShutterCurve &curve, int moments, const ShutterPart &open = {});

// A rolling shutter, which exposes the rows of a picture one after the other, from the top to the bottom.
//
// Its duration is the part of the shutter's whole time for which each row is exposed, from 0.001 to 1: the top edge of
// the display window is exposed in the first such part, its bottom edge in the last one. With 1, all rows are exposed
// together, for the whole time. Cycles has the same definition (rolling_shutter_duration).
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
