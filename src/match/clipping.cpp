#include "match/clipping.h"

#include "match/tuning.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

namespace sparselens {

namespace {

// The value from which pixels count as clipped; infinite: none is.
float clipped_from(std::span<const float> plane) {
    std::vector<float> values;
    std::ranges::copy_if(plane, std::back_inserter(values), [](float v) { return std::isfinite(v); });
    constexpr float none = std::numeric_limits<float>::infinity();
    if (values.empty()) return none;
    const double largest = double(*std::ranges::max_element(values));
    const auto above = [&](double share) {
        return double(std::ranges::count_if(values, [&](float v) { return double(v) >= share * largest; }));
    };
    const bool is_clipped = largest > 0 && above(MatchTuning::brightest) >=
                                               MatchTuning::clipped_share * above(MatchTuning::bright);
    return is_clipped ? float(MatchTuning::bright * largest) : none;
}

} // namespace

void raise_clipped(std::span<float> plane) {
    const float from = clipped_from(plane);
    for (float &value : plane)
        if (value >= from) value *= MatchTuning::clipped_factor;
}

} // namespace sparselens
