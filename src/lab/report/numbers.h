// Numbers as reports print them, with a point whatever the locale.
#pragma once

#include <string>

namespace sparselens::lab {

std::string fixed(double value, int decimals); // "-" for NaN, "inf"
std::string significant(double value, int digits);
std::string shortest(double value); // all digits it takes to read the same value again; "" for NaN

} // namespace sparselens::lab
