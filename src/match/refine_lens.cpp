#include "match/lens_search.h"
#include "match/tuning.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sparselens {

namespace {

constexpr std::size_t coc_change = 0, scale_change = 1, softness_change = 2, first_motion = 3;

// Keeps a guess within what lenses do: the focus is not beyond infinity, and where it is known, it stays.
BlurGuess allowed(BlurGuess guess, const Comparison &pictures, const KnownLens &known) {
    guess.scale = known.scale
                      ? *known.scale
                      : std::clamp(guess.scale, 0.05 * MatchTuning::narrowest_px / half_range(pictures),
                                   MatchTuning::widest * 1.5);
    guess.softness = std::clamp(guess.softness, 0.0, MatchTuning::most_softness);
    const double focus =
        known.focus ? *known.focus : std::max(pictures.middle + guess.coc / guess.scale, 0.0);
    guess.coc = guess.scale * (focus - pictures.middle);
    return guess;
}

Colours difference(Colours a, const Colours &b, double step) {
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < a.rgb[k].size(); ++i)
            a.rgb[k][i] = float((double(a.rgb[k][i]) - double(b.rgb[k][i])) / step);
    return a;
}

Colours of_size(const Grid &grid) {
    const std::vector<float> plane(grid.size());
    return {grid, {plane, plane, plane}};
}

// How a picture changes if it is blurred more along x than along y, and along the falling diagonal.
std::pair<Colours, Colours> motion_changes(const Colours &of) {
    Colours along = of_size(of.grid), across = along;
    const Imath::Box2i box = of.grid.box();
    for (std::size_t k = 0; k < 3; ++k)
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int x = box.min.x; x <= box.max.x; ++x) {
                const auto at = [&](int dx, int dy) {
                    return of.rgb[k][of.grid.index(std::clamp(x + dx, box.min.x, box.max.x),
                                                   std::clamp(y + dy, box.min.y, box.max.y))];
                };
                const std::size_t i = of.grid.index(x, y);
                along.rgb[k][i] = (at(1, 0) + at(-1, 0) - at(0, 1) - at(0, -1)) / 4;
                across.rgb[k][i] = (at(1, 1) + at(-1, -1) - at(1, -1) - at(-1, 1)) / 8;
            }
    return {std::move(along), std::move(across)};
}

// Solves the equations of the unknowns that are free, by elimination; the others stay 0.
using Matrix = std::array<Changes, most_changes>;
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

// The sums over all blocks, each weighed by the noise that its fit leaves.
struct Equations {
    Matrix stiffness{}, spread{};
    Changes pull{};
    int blocks = 0;

    explicit Equations(const std::vector<BlockFit> &fits) {
        for (const BlockFit &fit : fits) {
            if (fit.pixels == 0) continue;
            const double weight = 1 / fit.noise();
            ++blocks;
            for (std::size_t i = 0; i < most_changes; ++i) {
                pull[i] += weight * fit.pull[i];
                for (std::size_t k = 0; k < most_changes; ++k) {
                    stiffness[i][k] += weight * fit.stiffness[i][k];
                    spread[i][k] += weight * weight * fit.pull[i] * fit.pull[k];
                }
            }
        }
    }
};

class Refining {
public:
    Refining(const Comparison &pictures, const KnownLens &known) : pictures_(pictures), known_(known) {
        is_free_.fill(true);
        is_free_[coc_change] = !known.focus;
        is_free_[scale_change] = !known.scale;
    }

    LensFit from(BlurGuess guess, int steps) {
        guess = allowed(guess, pictures_, known_);
        LensFit best = fit(guess);
        double damping = 0;
        for (int step = 0; step < steps; ++step) {
            const auto [next, moved] = improved(best, damping);
            LensFit there = fit(next);
            if (there.likelihood < best.likelihood) {
                damping = damping == 0 ? 1 : damping * 4;
                continue;
            }
            damping /= 4;
            best = std::move(there);
            if (moved < MatchTuning::settled_px) break;
        }
        return best;
    }

private:
    Colours gathered(BlurGuess guess, bool exactly = false) const {
        guess = allowed(guess, pictures_, known_);
        return pictures_.gather(guess.coc, guess.scale, exactly);
    }

    // The pictures at a guess, and their derivatives.
    LensFit fit(const BlurGuess &guess) {
        LensFit result;
        result.guess = guess;
        const Colours linear = gathered(guess, true);
        result.shown = as_plate(linear, guess.softness);
        std::vector<Colours> changes(most_changes, of_size(linear.grid));
        const auto change = [&](double BlurGuess::*value, double step) {
            BlurGuess more = guess, less = guess;
            more.*value += step;
            less.*value = value == &BlurGuess::scale ? std::max(less.*value - step, 0.25 * less.*value)
                                                     : less.*value - step;
            return difference(as_plate(gathered(more), guess.softness),
                              as_plate(gathered(less), guess.softness), more.*value - less.*value);
        };
        if (is_free_[coc_change]) changes[coc_change] = change(&BlurGuess::coc, MatchTuning::derivative_px);
        if (is_free_[scale_change])
            changes[scale_change] =
                change(&BlurGuess::scale, MatchTuning::derivative_px / half_range(pictures_));
        const double less = std::max(guess.softness - MatchTuning::softness_step, 0.0),
                     more = guess.softness + MatchTuning::softness_step;
        changes[softness_change] = difference(as_plate(linear, more), as_plate(linear, less), more - less);
        auto [along, across] = motion_changes(result.shown);
        changes[first_motion] = std::move(along);
        changes[first_motion + 1] = std::move(across);
        result.blocks = fit_blocks(pictures_.plate, pictures_.usable, result.shown, changes);
        result.likelihood = likelihood_of(result.blocks);
        find_spread(result);
        return result;
    }

    void find_spread(LensFit &of) const {
        const Equations sums(of.blocks);
        auto with_motion = inverse(sums.stiffness, is_free_);
        const Changes all = times(with_motion, sums.pull);
        of.motion = all;
        auto lens_only = is_free_;
        lens_only[first_motion] = lens_only[first_motion + 1] = false;
        const Matrix known = inverse(sums.stiffness, lens_only);
        of.covariance = times(times(known, sums.spread), known);
        const double few = sums.blocks > 4 ? double(sums.blocks) / (sums.blocks - 3) : 4;
        for (Changes &row : of.covariance)
            for (double &v : row) v *= few;
    }

    // The next guess, and how far the CoC moves.
    std::pair<BlurGuess, double> improved(const LensFit &at, double damping) const {
        Equations sums(at.blocks);
        auto lens_only = is_free_;
        lens_only[first_motion] = lens_only[first_motion + 1] = false;
        for (std::size_t i = 0; i < most_changes; ++i) sums.stiffness[i][i] *= 1 + damping + 1e-6;
        Changes step = times(inverse(sums.stiffness, lens_only), sums.pull);
        const double range = half_range(pictures_);
        const auto reach = [&] {
            return std::max({std::abs(step[coc_change]), std::abs(step[scale_change]) * range,
                             std::abs(step[softness_change])});
        };
        if (const double far = reach(); far > MatchTuning::largest_step_px)
            for (double &v : step) v *= MatchTuning::largest_step_px / far;
        BlurGuess next = at.guess;
        next.coc += step[coc_change];
        next.scale = std::max(next.scale + step[scale_change], 0.4 * next.scale);
        next.softness += step[softness_change];
        return {allowed(next, pictures_, known_), reach()};
    }

    const Comparison &pictures_;
    const KnownLens &known_;
    std::array<bool, most_changes> is_free_{};
};

} // namespace

LensFit refine_lens(const Comparison &pictures, const KnownLens &known, BlurGuess guess, int steps) {
    return Refining(pictures, known).from(guess, steps);
}

} // namespace sparselens
