// Finds the facets of a picture slowly and simply, from the definition in dof/facets/facets.h and without the kernel's
// code: each step from pixel to pixel is searched anew. Tests find_facets().
#pragma once

#include "deep/ldi.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace sparselens {

// The three samples of each facet, in no particular order.
std::vector<std::array<std::uint64_t, 3>> find_facets_slowly(const Ldi &ldi, const ThinLens &lens,
                                                             double widest);

// The sample that an opaque sample of `pixel` (EXR coordinates) is linked to in the pixel one step on.
std::optional<std::uint64_t> linked_slowly(const Ldi &ldi, const ThinLens &lens, std::uint64_t sample,
                                           const Imath::V2i &pixel, const Imath::V2i &step);

} // namespace sparselens
