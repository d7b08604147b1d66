// Whether a gathered picture and a render were made through the same lens, as their headers say. What a header does not name is
// not compared.
#pragma once

#include "view/camera.h"

#include <string>
#include <vector>

namespace sparselens {

// What differs, in words: the aperture's radius, its blades, their rotation, its squeeze, and the focus distance. Blades are
// compared where both headers name them, 0 for none.
std::vector<std::string> lens_differences(const Camera &gathered, const Camera &render);

} // namespace sparselens
