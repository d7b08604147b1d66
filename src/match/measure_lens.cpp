#include "match/measure_lens.h"

#include "match/tuning.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sparselens {

namespace {

constexpr std::size_t coc_change = 0, ends_change = 1, first_motion = 3;

std::vector<BlockFit> blocks_at(const Comparison &pictures, const LikelyLens &at, const Slopes &slopes) {
    const double softness = at.guess.softness;
    const double less = std::max(softness - MatchTuning::softness_step, MatchTuning::least_softness),
                 more = softness + MatchTuning::softness_step;
    auto [along, across] = motion_changes(at.shown);
    const std::vector<Rgb> changes{
        slopes.by_coc, slopes.by_ends,
        difference(as_plate(pictures, at.linear, more), as_plate(pictures, at.linear, less), more - less),
        std::move(along), std::move(across)};
    return fit_blocks(pictures.plate, pictures.usable, at.shown, changes);
}

} // namespace

LensFit fit_with(const Comparison &pictures, const KnownLens &known, const LikelyLens &at,
                 const Slopes &slopes) {
    LensFit fit;
    fit.guess = at.guess;
    fit.shown = at.shown;
    fit.blocks = blocks_at(pictures, at, slopes);
    fit.likelihood = likelihood_of(fit.blocks);
    std::array<bool, most_changes> is_free;
    is_free.fill(true);
    is_free[coc_change] = !known.focus;
    is_free[ends_change] = !known.scale;
    fit.motion = solve_blocks(fit.blocks, is_free).by;
    is_free[first_motion] = is_free[first_motion + 1] = false; // no lens makes it
    const Matrix spread = solve_blocks(fit.blocks, is_free).covariance;
    const double per_end = 1 / half_range(pictures);
    fit.covariance = {spread[coc_change][coc_change], per_end * spread[coc_change][ends_change],
                      per_end * per_end * spread[ends_change][ends_change]};
    return fit;
}

namespace {

// The inverse for the unknowns that are free, by elimination; the others stay 0.
Matrix inverse(Matrix of, const std::array<bool, most_changes> &is_free) {
    Matrix result{};
    for (std::size_t i = 0; i < most_changes; ++i) {
        result[i][i] = is_free[i] ? 1 : 0;
        for (std::size_t k = 0; k < most_changes; ++k)
            if (!is_free[i] || !is_free[k]) of[i][k] = i == k ? 1 : 0;
    }
    for (std::size_t i = 0; i < most_changes; ++i) {
        const double pivot = std::max(of[i][i], 1e-30);
        for (std::size_t k = 0; k < most_changes; ++k) of[i][k] /= pivot, result[i][k] /= pivot;
        for (std::size_t j = 0; j < most_changes; ++j) {
            if (j == i) continue;
            const double share = of[j][i];
            for (std::size_t k = 0; k < most_changes; ++k) {
                of[j][k] -= share * of[i][k];
                result[j][k] -= share * result[i][k];
            }
        }
    }
    return result;
}

Changes times(const Matrix &a, const Changes &b) {
    Changes result{};
    for (std::size_t i = 0; i < most_changes; ++i)
        for (std::size_t k = 0; k < most_changes; ++k) result[i] += a[i][k] * b[k];
    return result;
}

Matrix times(const Matrix &a, const Matrix &b) {
    Matrix result{};
    for (std::size_t i = 0; i < most_changes; ++i)
        for (std::size_t j = 0; j < most_changes; ++j)
            for (std::size_t k = 0; k < most_changes; ++k) result[i][j] += a[i][k] * b[k][j];
    return result;
}

} // namespace

Solution solve_blocks(const std::vector<BlockFit> &blocks, const std::array<bool, most_changes> &is_free) {
    Matrix stiffness{}, spread{};
    Changes pull{};
    int count = 0;
    for (const BlockFit &block : blocks) {
        if (block.pixels == 0) continue;
        ++count;
        const double weight = 1 / block.left;
        for (std::size_t i = 0; i < most_changes; ++i) {
            pull[i] += weight * block.pull[i];
            for (std::size_t k = 0; k < most_changes; ++k) {
                stiffness[i][k] += weight * block.stiffness[i][k];
                spread[i][k] += weight * weight * block.pull[i] * block.pull[k];
            }
        }
    }
    const Matrix known = inverse(stiffness, is_free);
    Solution solution{times(known, pull), times(times(known, spread), known)};
    const double few = count > 4 ? double(count) / (count - 3) : 4;
    for (Changes &row : solution.covariance)
        for (double &v : row) v *= few;
    return solution;
}

namespace {

struct Softness {
    double value = 0, likelihood = 0;
};

// Where the parabola through three points is highest; they are in order, and the second is the highest.
double highest_of(const Softness &a, const Softness &b, const Softness &c) {
    const double left = (b.likelihood - a.likelihood) / (b.value - a.value),
                 right = (c.likelihood - b.likelihood) / (c.value - b.value);
    const double bend = (right - left) / (c.value - a.value);
    return bend < 0 ? (a.value + b.value) / 2 - left / (2 * bend) : b.value;
}

} // namespace

LikelyLens compared(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess) {
    const BlurGuess by = allowed(guess, pictures, known);
    LikelyLens result{by, 0, pictures.gather(by.coc, by.scale, true), {}};
    result.shown = as_plate(pictures, result.linear, by.softness);
    result.likelihood = likelihood_of(fit_blocks(pictures.plate, pictures.usable, result.shown, {}));
    return result;
}

LikelyLens softest(const Comparison &pictures, const KnownLens &known, const BlurGuess &guess) {
    LikelyLens best = compared(pictures, known, guess);
    const auto look = [&](double softness) {
        const Softness at{std::clamp(softness, MatchTuning::least_softness, MatchTuning::most_softness), 0};
        Rgb shown = as_plate(pictures, best.linear, at.value);
        const double there = likelihood_of(fit_blocks(pictures.plate, pictures.usable, shown, {}));
        if (there > best.likelihood) {
            best.likelihood = there;
            best.guess.softness = at.value;
            best.shown = std::move(shown);
        }
        return Softness{at.value, there};
    };
    // Goes up, with growing steps, until the highest point lies between two others.
    double step = MatchTuning::softness_step * (1 + std::max(best.guess.softness, 0.0));
    Softness middle{best.guess.softness, best.likelihood}, before = look(middle.value - step),
                                                           after = look(middle.value + step);
    if (before.likelihood > middle.likelihood) {
        std::swap(before, after);
        step = -step;
    }
    while (after.likelihood > middle.likelihood) {
        before = std::exchange(middle, after);
        after = look(middle.value + (step *= 2));
    }
    if (before.value != middle.value && after.value != middle.value) look(highest_of(before, middle, after));
    return best;
}

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
