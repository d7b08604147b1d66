// Finds the fillers of a picture slowly and simply, from the definition in dof/lens/fillers.h and without the kernel's
// code: each pixel searches its row and its column for grounds that continue up to it. Tests find_fillers().
#pragma once

#include "dof/lens/fillers.h"

#include <vector>

namespace sparselens {

// The fillers in the order of the pixels. Nothing outside `known` is known.
std::vector<Filler> find_fillers_slowly(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &known);

} // namespace sparselens
