#include "match/measure_lens.h"

#include "match/tuning.h"

#include <algorithm>
#include <utility>
#include <vector>

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

} // namespace sparselens
