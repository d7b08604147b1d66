// The value in the middle.
#pragma once

#include <algorithm>
#include <cstddef>
#include <ranges>

namespace sparselens {

// The median of at least one value; for an even number, the upper one of the two in the middle. Reorders them.
template <std::ranges::random_access_range Values>
auto median(Values &&values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace sparselens
