// Finds which samples of a cell of several pixels lie on one surface, however steep it is.
#pragma once

#include "dof/facets/links.h"

#include <cstdint>
#include <vector>

namespace sparselens {

// Returns, for each sample of the LDI, the first sample of its cell that links (facets.h) lead to from it, from pixel
// to pixel within the cell. Cells are `across` pixels wide and high; the first one begins at EXR coordinate (0, 0). The
// result is the sample itself if it shows an image (Ldi::optical), and in cells whose opaque samples lie at most
// `apart` pixels of perceptive depth from each other, where the answer is not needed. The LDI must have fewer than 2^32
// samples.
std::vector<std::uint32_t> joined_in_cells(const Ldi &ldi, const Links &links, int across, float apart);

} // namespace sparselens
