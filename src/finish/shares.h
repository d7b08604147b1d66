// The share of a candidate that is believed in each class of cells, from what both renders say of all cells of that class.
#pragma once

#include "finish/tuning.h"

#include <array>
#include <vector>

namespace sparselens {

inline constexpr std::size_t trust_classes = FinishTuning::classes; // of each of the two measures
using ClassTable = std::array<double, trust_classes * trust_classes>;

// Sums over the cells of each class, in one block of the picture.
struct ClassSums {
    ClassTable answers{};  // what the test confirms of the change
    ClassTable energies{}; // what there is to confirm
    ClassTable unseen{};   // variance of the answers, beside how blocks differ
};

// The share that fits the answers best, drawn towards 0 by its own variance, as blocks differ (W. James, C. Stein, 1961).
ClassTable shares_of(std::vector<ClassSums> blocks);

// Between the middles of classes, linear.
float share_at(const ClassTable &shares, float across, float down);

} // namespace sparselens
