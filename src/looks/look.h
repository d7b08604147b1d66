// The looks of a lens: what a row of their table (table.h) says, and what a look does to the lens.
#pragma once

#include "../lens/lens_looks.h"
#include "../lens/thin_lens.h"

#include <cmath>
#include <optional>

namespace sparselens {

// The numbers that a user may give for a parameter: in words, for messages, and as a test.
struct NumberRange {
    const char *words;
    bool (*holds)(double);
};
inline constexpr NumberRange above_0{"a number above 0", [](double v) { return v > 0 && std::isfinite(v); }},
    above_0_or_inf{"a number above 0, or inf", [](double v) { return v > 0; }},
    at_least_0_or_inf{"a number of at least 0, or inf", [](double v) { return v >= 0; }},
    at_least_0{"a number of at least 0", [](double v) { return v >= 0 && std::isfinite(v); }};

// A control among the looks on a page.
struct PageControl {
    const char *label = "";   // as photographers say; empty: no control
    double low = 0, high = 0; // the ends of a number's slider
    double usual = 0;         // the number if none is given
    int whole_from = 0;       // if not 0, the slider has `low`, and whole numbers from this one on
};

template <typename Values>
struct NumberParameter {
    const char *name; // "lens-radius": the name of an option, without dashes
    const char *unit, *help;
    std::optional<double> Values::*value;
    NumberRange range;
};

// A look of the lens: its numbers as a user gives them, with name, unit, range, help and slider, and what they do to
// the lens. Each look has a struct, which table.h lists:
//
//     struct NAME {
//         std::optional<double> name = {};                          // missing: the lens has none of it
//         static constexpr auto rows();                             // a LookRow for each number
//         void act(const LookContext &context, LensLooks &looks) const; // adds what it does to the lens
//     };

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
