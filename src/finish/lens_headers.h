// Compares the lenses of a gathered picture and a render by their headers. Values that a header lacks are not compared.
#pragma once

#include "view/camera.h"

#include <string>
#include <vector>

namespace sparselens {

// The differences, in words: the aperture's radius, its blades, their rotation, its squeeze, and the focus distance.
// Blades are compared if both headers name them, 0 for none.
std::vector<std::string> lens_differences(const Camera &gathered, const Camera &render);

} // namespace sparselens
