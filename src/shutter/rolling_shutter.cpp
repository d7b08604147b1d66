#include "shutter/rolling_shutter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sparselens {

ShutterPart exposure_of_row(int row, int rows, double duration) {
    const double middle = (std::clamp(row, 0, rows - 1) + 0.5) / rows;
    const double from = middle * (1 - duration);
    return {from, std::min(from + duration, 1.0)};
}

std::vector<std::vector<double>> row_weights(const ShutterCurve &curve, int moments, double duration,
                                             int rows) {
    std::vector weights(std::size_t(moments), std::vector(std::size_t(rows), 0.0));
    for (int row = 0; row < rows; ++row) {
        const std::vector<double> of_row =
            moment_weights(curve, moments, exposure_of_row(row, rows, duration));
        for (std::size_t m = 0; m < weights.size(); ++m) weights[m][std::size_t(row)] = of_row[m];
    }
    return weights;
}

LensShare share_of_moment(int moment, int moments, double duration) {
    const int seen = std::max(1, int(std::lround(moments * duration)));
    return {moment % seen, seen};
}

} // namespace sparselens
