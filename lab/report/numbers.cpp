#include "lab/report/numbers.h"

#include <charconv>
#include <cmath>

namespace sparselens::lab {

namespace {

template <typename... Format>
std::string as_text(double value, const char *unknown, Format... format) {
    if (std::isnan(value)) return unknown;
    char text[400]; // the largest double has 309 digits before the point
    return {text, std::to_chars(text, text + sizeof text, value, format...).ptr};
}

} // namespace

std::string fixed(double value, int decimals) {
    return as_text(value, "-", std::chars_format::fixed, decimals);
}

std::string significant(double value, int digits) {
    return as_text(value, "-", std::chars_format::general, digits);
}

std::string shortest(double value) { return as_text(value, ""); }

} // namespace sparselens::lab
