// Finds which samples of the pixels beside a sample show the same surface.
#pragma once

#include "deep/ldi.h"
#include "lens/thin_lens.h"

#include <array>
#include <cstdint>

namespace sparselens {

inline constexpr std::uint64_t no_neighbour = ~std::uint64_t(0);

struct SurfaceNeighbours {
    std::array<std::uint64_t, 4> sample; // left, right, up, down; or no_neighbour
    // How far both neighbours of the axis show the surface, (0, 1]; 0: one of them is missing.
    float horizontal, vertical;
    double along(std::size_t neighbour) const { return double(neighbour < 2 ? horizontal : vertical); }
};

// Returns the neighbours of sample i in pixel (x, y), which is relative to the data window's corner. A neighbour is the
// sample of its pixel that is nearest in perceptive depth, and closer than one_surface_px. From 3/4 of that distance on
// it shows the surface less and less, so that nothing changes suddenly as the aperture opens.
SurfaceNeighbours surface_neighbours(const Ldi &ldi, const ThinLens &lens, std::uint64_t i, int x, int y);

} // namespace sparselens
