#include "match/quadratic.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

using Terms = std::array<double, quadratic_terms>;

Terms terms_at(double x, double y) { return {1, x, y, x * x / 2, x * y, y * y / 2}; }

// Solves a positive definite system, whose matrix is symmetric, for many right sides, by elimination.
void solve(std::array<Terms, quadratic_terms> matrix,
           std::array<std::vector<double>, quadratic_terms> &sides) {
    for (std::size_t i = 0; i < quadratic_terms; ++i)
        for (std::size_t j = 0; j < quadratic_terms; ++j) {
            if (j == i) continue;
            const double share = matrix[j][i] / matrix[i][i];
            for (std::size_t k = i; k < quadratic_terms; ++k) matrix[j][k] -= share * matrix[i][k];
            for (std::size_t k = 0; k < sides[j].size(); ++k) sides[j][k] -= share * sides[i][k];
        }
    for (std::size_t i = 0; i < quadratic_terms; ++i)
        for (double &v : sides[i]) v /= matrix[i][i];
}

// Where the function with this slope and these second derivatives is highest in the disc of radius 1: the step s of
// (m I - H) s = slope with the smallest m >= 0 that makes it short enough and the matrix positive (More and Sorensen
// 1983), along the axes of H.
Place highest_in_disc(const Place &slope, double xx, double xy, double yy) {
    const double turn = 0.5 * std::atan2(2 * xy, xx - yy), c = std::cos(turn), s = std::sin(turn);
    const double middle = (xx + yy) / 2, more = std::hypot((xx - yy) / 2, xy);
    const Place bend{middle + more, middle - more},
        along{c * slope.x + s * slope.y, c * slope.y - s * slope.x};
    const auto step = [&](double m) { return Place{along.x / (m - bend.x), along.y / (m - bend.y)}; };
    const double size = std::abs(bend.x) + std::abs(bend.y) + std::hypot(slope.x, slope.y) + 1e-300;
    double least = std::max(bend.x, 0.0) + 1e-9 * size, most = least + size;
    Place best = step(least);
    if (distance(best, {}) > 1)
        for (int i = 0; i < 60; ++i) {
            const double m = (least + most) / 2;
            best = step(m);
            (distance(best, {}) > 1 ? least : most) = m;
        }
    else if (bend.x > 0) // a valley: to its side
        best.x = std::copysign(std::sqrt(std::max(1 - best.y * best.y, 0.0)), best.x);
    return {c * best.x - s * best.y, s * best.x + c * best.y};
}

} // namespace

double distance(const Place &a, const Place &b) { return std::hypot(a.x - b.x, a.y - b.y); }

Quadratic::Quadratic(std::span<const Place> places, const Place &middle, double reach)
    : middle_(middle), reach_(reach) {
    constexpr Terms least{0, 1e-6, 1e-6, 1e-4, 1e-4, 1e-4}; // draws terms to 0
    std::array<Terms, quadratic_terms> products{};
    for (std::size_t i = 0; i < quadratic_terms; ++i) products[i][i] = least[i];
    for (const Place &place : places) {
        const Terms at = terms_at((place.x - middle.x) / reach, (place.y - middle.y) / reach);
        for (std::size_t i = 0; i < quadratic_terms; ++i) {
            for (std::size_t k = 0; k < quadratic_terms; ++k) products[i][k] += at[i] * at[k];
            shares_[i].push_back(at[i]);
        }
    }
    solve(products, shares_);
}

Place Quadratic::best(std::span<const double> values) const {
    Terms terms{};
    for (std::size_t i = 0; i < quadratic_terms; ++i)
        for (std::size_t p = 0; p < values.size(); ++p) terms[i] += shares_[i][p] * values[p];
    const auto [x, y] = highest_in_disc({terms[1], terms[2]}, terms[3], terms[4], terms[5]);
    return {middle_.x + reach_ * x, middle_.y + reach_ * y};
}

} // namespace sparselens
