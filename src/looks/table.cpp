#include "looks/table.h"

#include "base/error.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace sparselens {

double focal_length_for(const char *look, const LookContext &context) {
    if (context.focal_length_mm) return *context.focal_length_mm;
    throw UsageError(fmt::format("`{}` needs the focal length: give `focal_length`", look));
}

namespace {

template <typename... Look>
std::vector<LookNumber> numbers_of(const LookTable<Look...> &) {
    std::vector<LookNumber> numbers;
    const auto add = [&](const auto &rows) {
        for (const auto &row : rows)
            numbers.push_back({{row.name, row.unit, row.help, row.value, row.range}, row.control});
    };
    (add(Look::rows()), ...);
    return numbers;
}

constexpr NumberRange gain{"a number from 1 to 1000", [](double v) { return v >= 1 && v <= 1000; }};

constexpr std::array highlights{
    LookNumber{{"highlight-gain", "G",
                "Make lights up to G times as bright before the gather, from 1 to 1000 (default: 1)",
                &LookValues::highlight_gain, gain},
               {"brighter lights", 1, 50, 1}},
    LookNumber{{"highlight-threshold", "Y",
                "Scene-linear luminance above which lights become brighter (default: 1)",
                &LookValues::highlight_threshold, at_least_0},
               {"lights: above", 0, 20, 1}},
    LookNumber{{"highlight-knee", "Y",
                "Range of luminance above the threshold over which the gain rises (default: 1)",
                &LookValues::highlight_knee, above_0},
               {"lights: softness", 0.001, 20, 1}},
};

} // namespace

std::span<const LookNumber> look_numbers() {
    static const auto numbers = numbers_of(LookValues());
    return numbers;
}
std::span<const LookNumber> highlight_numbers() { return highlights; }

std::span<const std::pair<const char *, ChromaticType>> chromatic_types() {
    return looks::AxialChromatic::types;
}

bool is_tilt(double degrees) { return std::abs(degrees) <= 89; }

LookValues look_values_over(const LookValues &above, const LookValues &below) {
    LookValues both = above;
    for (const auto table : {look_numbers(), highlight_numbers()})
        for (const LookNumber &number : table)
            if (auto &value = both.*number.value; !value) value = below.*number.value;
    if (!both.picture && !above.blades) both.picture = below.picture;
    if (above.picture && !above.blades) both.blades.reset();
    if (!both.tilt_x) both.tilt_x = below.tilt_x, both.tilt_y = below.tilt_y;
    if (!both.chromatic_type) both.chromatic_type = below.chromatic_type;
    if (!both.cat_eye_darkening) both.cat_eye_darkening = below.cat_eye_darkening;
    return both;
}

} // namespace sparselens
