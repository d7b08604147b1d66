// Samples of partial coverage that a tile may see, front to back. What is needed of them is stored contiguously in that
// order, because they are many.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/sample_blocks.h"
#include "kernels/lens_layout.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sparselens {

struct PartialSamples {
    std::vector<std::uint32_t> sample; // of the BlockedSamples
    std::vector<float> x, y, coc, depth;
    std::vector<float> left; // what each leaves of the light behind it
    std::vector<std::uint64_t> key;

    std::size_t count() const { return sample.size(); }
};

// The samples that some lens point brings into the tile, or into a pixel next to it.
PartialSamples partial_samples_of(const BlockedSamples &samples, const TileTask &tile);

} // namespace sparselens
