// How much light a shutter passes while it is open, and what each of its moments counts.
#pragma once

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

} // namespace sparselens
