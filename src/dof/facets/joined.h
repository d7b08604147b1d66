// Which samples of a cell of several pixels lie on one surface, however steep that is.
#pragma once

#include "dof/facets/links.h"

#include <cstdint>
#include <vector>

namespace sparselens {

// Cells are `across` pixels wide and high, the first one at EXR coordinate (0, 0). For each sample of the LDI, the first one of those
// of its cell that links (facets.h) lead to from it, from pixel to pixel within the cell. Itself in cells whose opaque samples lie
// `apart` pixels of perceptive depth or less from each other, where nobody needs to know, and where it shows an image (Ldi::optical). The LDI has less than 2^32 samples.
std::vector<std::uint32_t> joined_in_cells(const Ldi &ldi, const Links &links, int across, float apart);

} // namespace sparselens
