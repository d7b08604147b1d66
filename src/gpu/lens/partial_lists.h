// Lists of the samples of partial coverage that a tile's lens points can bring into each of its quarters: front to
// back, and in ascending order where depths are equal.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/sample_blocks.h"
#include "kernels/lens_layout.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sparselens::gpu {

using PartialLists = std::array<std::vector<std::uint32_t>, lens_kernel::quarters>;

PartialLists partial_lists(const BlockedSamples &samples, const TileTask &task);

} // namespace sparselens::gpu
