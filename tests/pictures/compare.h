// Compares two pictures: the data windows, the channels by name, the samples of each pixel and their values. Other
// contents of a file, and the number of bits it keeps of a value, do not count.
#pragma once

#include "pictures/picture.h"

#include <string>
#include <vector>

namespace pictures {

// Describes the first difference and the largest; empty if there is none. Without a tolerance 0 and -0 differ; equal
// infinities are equal, and so are NaNs. `names`: compares only these channels, which both pictures must have; all if
// it is empty.
std::string difference(const Picture &a, const Picture &b, const std::vector<std::string> &names,
                       double tolerance);

} // namespace pictures
