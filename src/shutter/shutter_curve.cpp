#include "shutter/shutter_curve.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sparselens {

ShutterCurve box_shutter() { return {{{0, 1}, {1, 1}}}; }

ShutterCurve triangle_shutter() { return {{{0, 0}, {0.5, 1}, {1, 0}}}; }

ShutterCurve gaussian_shutter() {
    constexpr int pieces = 1024;
    ShutterCurve curve;
    for (int i = 0; i <= pieces; ++i) {
        const double time = double(i) / pieces, deviations = (time - 0.5) * 6;
        curve.points.push_back({time, std::exp(-0.5 * deviations * deviations)});
    }
    return curve;
}

// Times are counted in moments, so that a box gives each moment exactly the same weight.
std::vector<double> moment_weights(const ShutterCurve &curve, int moments, const ShutterPart &open) {
    std::vector<double> weights(std::size_t(moments), 0.0);
    const auto at = [&](double time) { return (open.from + time * (open.to - open.from)) * moments; };
    for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
        const auto &[from_time, from] = curve.points[i];
        const auto &[to_time, to] = curve.points[i + 1];
        const double begin = at(from_time), end = at(to_time);
        if (begin == end) continue; // too short to count
        for (int m = int(begin); m < moments && m < end; ++m) {
            const double first = std::max(begin, double(m)), last = std::min(end, m + 1.0);
            const double middle = ((first + last) / 2 - begin) / (end - begin);
            weights[std::size_t(m)] += std::lerp(from, to, middle) * (last - first);
        }
    }
    return weights;
}

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
