#include "deep/checks/flicker.h"

#include "base/numbers.h"
#include "lens/photograph.h"
#include "view/flat_pixels.h"

#include <cmath>
#include <utility>
#include <vector>

namespace sparselens {

double Flicker::since_last(View frame) {
    constexpr double still = 0.02; // a change of colour, relative to its size, as noise makes it
    const View before = std::exchange(last_, std::move(frame));
    if (before.z.size() != last_.z.size()) return 0;
    const FlatPixels from = flat_pixels(before), to = flat_pixels(last_);
    std::vector<double> changes;
    for (std::size_t i = 0; i < last_.z.size(); ++i)
        if (relative_difference(from.colour(i), to.colour(i)) < still)
            changes.push_back(
                std::abs(disparity_of_depth(double(from.z[i])) - disparity_of_depth(double(to.z[i]))));
    return changes.size() * 10 < last_.z.size() ? 0 : median(changes);
}

} // namespace sparselens
