// Bounds of the samples, among many, that are nearer than some depth. Samples outside these bounds cast no shadow on a
// lamp.
#pragma once

#include <cstddef>
#include <vector>

namespace sparselens {

// Bounds of all samples nearer than some depth, and perhaps of some others.
struct NearBounds {
    float depth; // of the nearest sample that is not included, perceptive, pixels
    float x_min, x_max, y_min, y_max, coc_min, coc_max;
};

class NearSteps {
public:
    NearSteps() = default;
    // Takes the depth and the extent of each sample. One step is kept for every `in_step` samples.
    NearSteps(std::vector<NearBounds> samples, std::size_t in_step);

    // The bounds of all samples nearer than a depth; null: there are none.
    const NearBounds *nearer_than(float depth) const;

private:
    // Each step includes more samples, the nearest first. The first step has none, the last one has all.
    std::vector<NearBounds> steps_;
};

} // namespace sparselens
