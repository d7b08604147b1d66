// The highlights that a plate clips, because a sensor and a file have a largest value. How bright they were is unknown.
// In a gathered picture, a pixel that a bright lamp covers in part is nearly as bright as the lamp. In a reduced plate it
// would be grey, so discs, and with them the lens, would look smaller.
#pragma once

#include <span>

namespace sparselens {

// Makes the clipped values of one channel of a plate brighter. Other values stay.
void raise_clipped(std::span<float> plane);

} // namespace sparselens
