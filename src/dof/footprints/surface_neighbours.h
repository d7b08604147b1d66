// Which samples of the pixels beside a sample show the same surface.
#pragma once

#include "deep/ldi.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>

namespace sparselens {

inline constexpr std::uint64_t no_neighbour = ~std::uint64_t(0);

struct SurfaceNeighbours {
    std::array<std::uint64_t, 4> sample; // left, right, up, down; or no_neighbour
    float horizontal, vertical;          // how far both of the axis show it, (0, 1]; 0: one is not there
    double along(std::size_t neighbour) const { return double(neighbour < 2 ? horizontal : vertical); }
};

// The neighbours of sample i, in pixel (x, y) from the corner of the data window. A neighbour is the sample of its
// pixel that is nearest in perceptive depth, and nearer than one_surface_px; from 3/4 of that on it shows the surface
// less and less, so that nothing changes at once as the aperture opens.
SurfaceNeighbours surface_neighbours(const Ldi &ldi, const ThinLens &lens, std::uint64_t i, int x, int y);

} // namespace sparselens
