// A look of the lens: a number as a user gives it, with its name, unit, range, help and slider, and what it does to the
// lens. Each look has a struct in a file of its own, which table.h lists:
//
//     struct NAME {
//         std::optional<double> name = {};                          // missing: the lens has none of it
//         static constexpr auto rows();                             // a LookRow for each number
//         void act(const LookContext &context, LensLooks &looks) const; // adds what it does to the lens
//     };
#pragma once

#include "../lens/lens_looks.h"
#include "../lens/thin_lens.h"
#include "number_parameter.h"

#include <array>
#include <cmath>
#include <optional>

namespace sparselens {

// The lens that a look acts on.
struct LookContext {
    ThinLens lens;
    std::optional<double> focal_length_mm = {}; // (0, inf)
    double metres_per_unit = 1;                 // (0, inf)
};

// The focal length in mm. Throws UsageError, which names the look, if it is unknown.
double focal_length_for(const char *look, const LookContext &context);

template <typename Look>
struct LookRow : NumberParameter<Look> {
    PageControl control = {};
};

template <typename... Look>
struct LookTable : Look... {
    void act(const LookContext &context, LensLooks &looks) const { (Look::act(context, looks), ...); }
};

inline constexpr NumberRange from_0_to_1{"a number from 0 to 1", [](double v) { return v >= 0 && v <= 1; }};
inline constexpr NumberRange from_minus_1_to_1{"a number from -1 to 1",
                                               [](double v) { return std::abs(v) <= 1; }};

} // namespace sparselens
