// Numbers as reports print them, with a decimal point in every locale.
#pragma once

#include <string>

namespace sparselens::lab {

std::string fixed(double value, int decimals); // "-" for NaN, "inf"
std::string significant(double value, int digits);
std::string shortest(double value); // the fewest digits that read back as the same value; "" for NaN

} // namespace sparselens::lab
