// Classes of equal weight along a measure, and the continuous place of a value in them; and the share of a candidate
// that is believed in each.
#pragma once

#include "finish/tuning.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace sparselens {

class Classes {
public:
    // For values in [least, most]; other values count as the nearer limit.
    Classes(std::size_t count, float least, float most);

    // Each pixel counts half by its weight and half equally, so that neither many pixels of little weight nor a few of
    // great weight make up all classes.
    void add(float value, double weight);
    void divide(); // after the last add()

    std::size_t of(float value) const; // [0, count)
    float place_of(float value) const; // the same, continuous: k + 1/2 in the middle of class k

private:
    float bin_of(float value) const; // continuous

    std::size_t count_;
    float least_, most_;
    std::vector<std::array<double, 2>> bins_; // pixels, weights
    std::vector<float> places_;               // of the beginnings of bins, and of the last end
};

inline constexpr std::size_t trust_classes = FinishTuning::classes; // of each of the two measures
inline constexpr std::size_t table_size = trust_classes * trust_classes;
using ClassTable = std::array<double, table_size>;
using Shares = std::array<float, table_size>;

// Sums over the cells of each class, in one block of the picture.
struct ClassSums {
    ClassTable answers{};  // the part of the change that the test confirms
    ClassTable energies{}; // energy of the change, plus the cost of its noise
    ClassTable unseen{};   // variance of the answers, in addition to that between blocks
};

// The share of a candidate that is believed in each class of cells, from the evidence of both renders in all its cells:
// the share that fits the answers best, drawn towards 0 by its own variance between blocks (W. James, C. Stein, 1961).
Shares shares_of(std::vector<ClassSums> blocks);

// Interpolates linearly between the middles of classes.
inline float share_at(const Shares &shares, float across, float down) {
    constexpr auto last = float(trust_classes - 1);
    const float i = std::clamp(across - 0.5f, 0.0f, last), j = std::clamp(down - 0.5f, 0.0f, last);
    const std::size_t column = std::min(std::size_t(i), trust_classes - 2),
                      row = std::min(std::size_t(j), trust_classes - 2);
    const float x = i - float(column), y = j - float(row);
    const float *at = shares.data() + row * trust_classes + column, *below = at + trust_classes;
    return (1 - y) * ((1 - x) * at[0] + x * at[1]) + y * ((1 - x) * below[0] + x * below[1]);
}

} // namespace sparselens
