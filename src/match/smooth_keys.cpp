#include "match/smooth_keys.h"

#include "base/numbers.h"
#include "match/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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
    double log_determinant() const {
        double sum = 0;
        for (const auto &row : rows_) sum += std::log(row[0]);
        return sum;
    }

private:
    std::vector<std::array<double, 3>> rows_; // [row][distance to the main diagonal]
};

constexpr std::array<double, 3> second{1, -2, 1}; // differences

Banded equations(std::span<const double> weights, double stiffness) {
    Banded of(weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) of.add(i, i, weights[i]);
    for (std::size_t t = 0; t + 2 < weights.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k <= i; ++k) of.add(t + i, t + k, stiffness * second[i] * second[k]);
    of.decompose();
    return of;
}

// The curve of a stiffness.
struct Curve {
    double stiffness = 0;
    std::vector<double> values;
    double variance = 1; // the square of the factor of all deviations
    double unlikely = 0; // -2 times the logarithm of the likelihood, up to a constant
};

// Unknown values, whose weight is 0, get a little weight, so that one known value is enough.
std::vector<double> raised(std::span<const double> weights) {
    std::vector<double> result(weights.begin(), weights.end());
    const double least = 1e-9 * *std::ranges::max_element(weights);
    for (double &w : result) w += least;
    return result;
}

// `weights`: 0 where a value is unknown.
Curve curve_by(std::span<const KeyedValue> keys, std::span<const double> weights, double stiffness) {
    const std::size_t n = keys.size();
    std::vector<double> pulled(n);
    double known = MatchTuning::given_deviations;
    for (std::size_t i = 0; i < n; ++i) {
        if (!(weights[i] > 0)) continue;
        pulled[i] = weights[i] * keys[i].value;
        ++known;
    }
    const Banded of = equations(raised(weights), stiffness);
    Curve curve{stiffness, of.solve(std::move(pulled)), 1, 0};
    const std::vector<double> &x = curve.values;
    double squares = MatchTuning::given_deviations;
    for (std::size_t i = 0; i < n; ++i)
        if (weights[i] > 0) squares += weights[i] * std::pow(x[i] - keys[i].value, 2);
    for (std::size_t t = 0; t + 2 < n; ++t)
        squares += stiffness * std::pow(second[0] * x[t] + second[1] * x[t + 1] + second[2] * x[t + 2], 2);
    const double free = std::max(known - 2, 1.0);
    curve.variance = squares / free;
    curve.unlikely = free * std::log(squares) + of.log_determinant() - (double(n) - 2) * std::log(stiffness);
    return curve;
}

// Errors have the tails of Student's t distribution, so values far from the curve hardly count.
std::vector<double> robust_weights(std::span<const KeyedValue> keys, const Curve &curve) {
    constexpr double tails = MatchTuning::tails;
    std::vector<double> weights;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const double weight = 1 / (keys[i].deviation * keys[i].deviation),
                     square = weight * std::pow(curve.values[i] - keys[i].value, 2) / curve.variance;
        weights.push_back(weight * (tails + 1) / (tails + square));
    }
    return weights;
}

// The median of each value and its four neighbours, with which values that are far off are found at first.
Curve medians(std::span<const KeyedValue> keys) {
    Curve curve{0, std::vector<double>(keys.size()), 1, 0};
    std::vector<double> off;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        std::vector<double> some;
        for (std::size_t k = i < 2 ? 0 : i - 2; k < std::min(i + 3, keys.size()); ++k)
            if (std::isfinite(keys[k].deviation)) some.push_back(keys[k].value);
        curve.values[i] = some.empty() ? keys[i].value : median(some);
        if (std::isfinite(keys[i].deviation))
            off.push_back(std::pow((keys[i].value - curve.values[i]) / keys[i].deviation, 2));
    }
    curve.variance = std::max(curve.variance, median(off));
    return curve;
}

Curve likeliest(std::span<const KeyedValue> keys, std::span<const double> weights) {
    const double weight = *std::ranges::max_element(weights);
    Curve best = curve_by(keys, weights, MatchTuning::stiffest * weight);
    for (double stiffness = best.stiffness; stiffness > MatchTuning::least_stiff * weight; stiffness /= 2) {
        Curve next = curve_by(keys, weights, stiffness);
        if (next.unlikely < best.unlikely) best = std::move(next);
    }
    return best;
}

} // namespace

std::vector<KeyedValue> smooth_keys(std::span<const KeyedValue> keys) {
    Curve curve = medians(keys);
    std::vector<double> weights;
    for (int pass = 0; pass < MatchTuning::robust_passes; ++pass) {
        weights = robust_weights(keys, curve);
        curve = likeliest(keys, weights);
    }
    const Banded of = equations(raised(weights), curve.stiffness);
    std::vector<KeyedValue> result;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        std::vector<double> one(keys.size());
        one[i] = 1;
        result.push_back({curve.values[i], std::sqrt(curve.variance * of.solve(std::move(one))[i])});
    }
    return result;
}

} // namespace sparselens
