// Numbers that a user may give, as options, keywords and, for looks, keys of a lens file. One table makes them all.
#pragma once

#include <cmath>
#include <optional>

namespace sparselens {

struct NumberRange {
    const char *words;
    bool (*holds)(double);
};
inline constexpr NumberRange above_0{"a number above 0", [](double v) { return v > 0 && std::isfinite(v); }},
    above_0_or_inf{"a number above 0, or inf", [](double v) { return v > 0; }},
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

} // namespace sparselens
