// The highlights that a plate clips, because a sensor and a file have a largest value. How bright they were is unknown,
// but a pixel of a reduced plate that a bright lamp covers in part must be nearly as bright as the lamp, as it is in a
// gathered picture. Otherwise discs look smaller, and so does the lens.
#pragma once

#include <span>

namespace sparselens {

// Makes the clipped values of one channel of a plate brighter. Other values stay.
void raise_clipped(std::span<float> plane);

} // namespace sparselens
