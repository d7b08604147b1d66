#include "match/clipping.h"

#include "match/tuning.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace sparselens {

namespace {

// The value from which pixels count as clipped; infinite: none is.
float clipped_from(const std::vector<float> &plane) {
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

std::vector<std::uint8_t> clipped_pixels(const Colours &plate) {
    std::vector<std::uint8_t> result(plate.grid.size());
    for (const std::vector<float> &plane : plate.rgb) {
        const float from = clipped_from(plane);
        for (std::size_t i = 0; i < plane.size(); ++i)
            if (plane[i] >= from) result[i] = 1;
    }
    return result;
}

} // namespace sparselens
