// The picture of an open shutter: how much light it passes, and the mean of the pictures of its moments.
#pragma once

#include "base/image.h"
#include "base/matte.h"
#include "lens/lens_points.h"
#include "lens/lens_samples.h"

#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

// The picture of an open shutter: the mean of the pictures of its moments, taken one after the other.
//
// Light, coverage and data are averaged by the weights of the moments, which may differ from row to row. Outside of its
// data window, a moment's picture is empty. The coverage of each id of a Cryptomatte is averaged, and the ids are
// ranked anew. Other ids have no mean: they are those of the middle moment.
class ShutterMean {
public:
    // Adds the picture of a moment. All have the same display window and the same channels; their data windows may
    // differ. `weights`, each at least 0, are those of the rows of the display window, from the top; rows beyond it
    // have the weight of its first or last row. Results depend on the order of the moments, within rounding.
    void add(const Image &picture, std::span<const double> weights, bool is_middle);

    // The mean; its data window is the smallest that holds those of all moments. In each row, the sum of weights must
    // be above 0.
    Image take();

private:
    void grow(const Imath::Box2i &data);
    void add_row(const Image &picture, int y, double weight, bool is_middle);
    void divide_row(int y);
    std::size_t weighted_row(int y) const; // the row of the display window whose weight counts

    Image sum_;
    std::vector<float> weights_; // of each row; rounded as sums are, so that the mean of ones is one
    std::vector<Matte> mattes_;
    std::vector<std::vector<IdCoverage>> coverages_; // [matte][pixel]
};

// How much light a shutter passes while it is open, and what each of its moments counts, in each row if it rolls.

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

// The weights of the moments in each row of the display window, [moment][row], of which only the ratios within a row
// count: the largest is from 1 to 2, so that floats hold them. Each row's own exposure has the whole curve.
std::vector<std::vector<double>> row_weights(const ShutterCurve &curve, int moments, double duration,
                                             int rows);

// The share of the lens points that a moment takes: those moments that one row sees have all of them together.
LensShare share_of_moment(int moment, int moments, double duration);

// Divides a set of lens points between the moments of a shutter.
//
// The shares of all moments together are the set that a still takes, so that a scene that stands still looks like the
// still. The points of each share are spread over the lens and over the pixel, so that each moment shows whole discs.

// The points of one moment, in their order. Shares differ by one point at most. If there are fewer points than moments,
// several moments take the same point.
std::vector<LensSample> shared_points(std::vector<LensSample> points, const LensShare &share);

} // namespace sparselens
