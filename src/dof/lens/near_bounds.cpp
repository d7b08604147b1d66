#include "dof/lens/near_bounds.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace sparselens {

namespace {

constexpr float none = std::numeric_limits<float>::infinity();

void extend(NearBounds &bounds, const NearBounds &by) {
    bounds.x_min = std::min(bounds.x_min, by.x_min);
    bounds.x_max = std::max(bounds.x_max, by.x_max);
    bounds.y_min = std::min(bounds.y_min, by.y_min);
    bounds.y_max = std::max(bounds.y_max, by.y_max);
    bounds.coc_min = std::min(bounds.coc_min, by.coc_min);
    bounds.coc_max = std::max(bounds.coc_max, by.coc_max);
}

} // namespace

// Works in place: a step overwrites samples that it already includes.
NearSteps::NearSteps(std::vector<NearBounds> samples, std::size_t in_step) : steps_(std::move(samples)) {
    std::ranges::sort(steps_, std::ranges::greater(), &NearBounds::depth);
    std::size_t steps = 0;
    NearBounds bounds{0, none, -none, none, -none, none, -none};
    for (std::size_t n = 0; n < steps_.size(); ++n) {
        const NearBounds sample = steps_[n];
        bounds.depth = sample.depth;
        if (n % in_step == 0) steps_[steps++] = bounds;
        extend(bounds, sample);
    }
    bounds.depth = -none;
    steps_.resize(steps);
    if (in_step > 1) steps_.shrink_to_fit();
    steps_.push_back(bounds);
}

const NearBounds *NearSteps::nearer_than(float depth) const {
    const auto is_too_few = [&](const NearBounds &step) { return step.depth > depth; };
    const auto step = std::ranges::partition_point(steps_, is_too_few);
    return step == steps_.begin() ? nullptr : &*step;
}

} // namespace sparselens
