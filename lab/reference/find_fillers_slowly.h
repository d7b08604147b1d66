// The fillers of a picture, slow and obvious, from what dof/lens/fillers.h says and none of the kernel's code: each pixel looks along
// its row and its column for the grounds that go on as far as to it. Tests find_fillers().
#pragma once

#include "dof/lens/fillers.h"

#include <vector>

namespace sparselens {

// In the order of the pixels. Nothing is known outside `known`.
std::vector<Filler> find_fillers_slowly(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &known);

} // namespace sparselens
