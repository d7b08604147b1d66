#include "match/equations.h"

#include <algorithm>

namespace sparselens {

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
