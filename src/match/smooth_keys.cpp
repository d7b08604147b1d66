#include "match/smooth_keys.h"

#include "match/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

// The lower half of a symmetric matrix with two diagonals beside the main one, as L D L^T.
class Banded {
public:
    explicit Banded(std::size_t size) : rows_(size) {}

    void add(std::size_t i, std::size_t k, double v) { rows_[i][i - k] += v; } // k <= i <= k + 2

    void decompose() {
        for (std::size_t i = 0; i < rows_.size(); ++i)
            for (std::size_t back = std::min<std::size_t>(2, i) + 1; back-- > 0;) {
                const std::size_t k = i - back;
                double v = rows_[i][back];
                for (std::size_t j = i >= 2 ? i - 2 : 0; j < k; ++j)
                    if (k - j <= 2) v -= rows_[i][i - j] * rows_[k][k - j] * rows_[j][0];
                rows_[i][back] = back == 0 ? v : v / rows_[k][0];
            }
    }
    std::vector<double> solve(std::vector<double> b) const {
        const std::size_t n = rows_.size();
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t back = 1; back <= std::min<std::size_t>(2, i); ++back)
                b[i] -= rows_[i][back] * b[i - back];
        for (std::size_t i = 0; i < n; ++i) b[i] /= rows_[i][0];
        for (std::size_t i = n; i-- > 0;)
            for (std::size_t ahead = 1; ahead <= 2 && i + ahead < n; ++ahead)
                b[i] -= rows_[i + ahead][ahead] * b[i + ahead];
        return b;
    }

private:
    std::vector<std::array<double, 3>> rows_; // [row][distance to the main diagonal]
};

Banded equations(std::span<const double> weights, double stiffness) {
    Banded of(weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) of.add(i, i, weights[i]);
    constexpr std::array<double, 3> second{1, -2, 1};
    for (std::size_t t = 0; t + 2 < weights.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k <= i; ++k) of.add(t + i, t + k, stiffness * second[i] * second[k]);
    of.decompose();
    return of;
}

struct Curve {
    std::vector<double> values, weights;
    double excess =
        0; // mean of the squared distances of the values, in deviations, each at most `far` squared
};

Curve curve_by(std::span<const KeyedValue> keys, double stiffness) {
    const std::size_t n = keys.size();
    Curve curve{std::vector<double>(n), std::vector<double>(n), 0};
    for (std::size_t i = 0; i < n; ++i) curve.weights[i] = 1 / (keys[i].deviation * keys[i].deviation);
    std::vector<double> huber(n, 1);
    for (int pass = 0; pass < MatchTuning::robust_passes; ++pass) {
        std::vector<double> weights(n), pulled(n);
        double least = 0;
        for (std::size_t i = 0; i < n; ++i) {
            weights[i] = curve.weights[i] * huber[i];
            least = std::max(least, weights[i]);
            pulled[i] = weights[i] > 0 ? weights[i] * keys[i].value : 0;
        }
        for (double &w : weights) w += 1e-9 * least; // so that one known value is enough
        curve.values = equations(weights, stiffness).solve(std::move(pulled));
        double sum = 0, known = 0;
        for (std::size_t i = 0; i < n; ++i) {
            if (!(curve.weights[i] > 0)) continue;
            const double off = std::abs(curve.values[i] - keys[i].value) / keys[i].deviation;
            huber[i] = std::min(1.0, MatchTuning::far_deviations / std::max(off, 1e-9));
            sum += std::min(off * off, MatchTuning::far_deviations * MatchTuning::far_deviations);
            ++known;
        }
        curve.excess = sum / known;
    }
    for (std::size_t i = 0; i < n; ++i) curve.weights[i] *= huber[i];
    return curve;
}

} // namespace

std::vector<KeyedValue> smooth_keys(std::span<const KeyedValue> keys) {
    double weight = 0;
    for (const KeyedValue &key : keys) weight = std::max(weight, 1 / (key.deviation * key.deviation));
    double stiffness = MatchTuning::stiffest * weight;
    Curve curve = curve_by(keys, stiffness);
    for (; curve.excess > MatchTuning::smooth_excess && stiffness > MatchTuning::least_stiff * weight;
         stiffness /= 2)
        curve = curve_by(keys, stiffness);
    for (double &w : curve.weights) w += 1e-9 * weight;
    const Banded of = equations(curve.weights, stiffness);
    std::vector<KeyedValue> result;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        std::vector<double> one(keys.size());
        one[i] = 1;
        const double deviation = std::sqrt(of.solve(std::move(one))[i]);
        result.push_back({curve.values[i], std::min(deviation, keys[i].deviation)});
    }
    return result;
}

} // namespace sparselens
