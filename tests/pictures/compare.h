// Whether two pictures hold the same: the data windows, the channels by name, the samples of each pixel and their values. What
// else a file says, and how many bits it keeps of a value, does not count.
#pragma once

#include "pictures/picture.h"

#include <string>
#include <vector>

namespace pictures {

// What the first difference is, and the largest; empty where there is none. Without a tolerance 0 and -0 differ; infinities equal
// themselves, and so do values that are no numbers. `names`: these channels alone, which
// both have to have; all if it is empty.
std::string difference(const Picture &a, const Picture &b, const std::vector<std::string> &names,
                       double tolerance);

} // namespace pictures
