#include "lab/reporting/steps.h"

#include <algorithm>

namespace sparselens::lab {

std::size_t StepList::add(Step step) {
    const auto found = std::ranges::find(steps_, step.name, &Step::name);
    if (found != steps_.end()) return std::size_t(found - steps_.begin());
    steps_.push_back(std::move(step));
    return steps_.size() - 1;
}

} // namespace sparselens::lab
