// A GPU that gathers tiles of the lens picture (lens_tile.comp): opaque samples and samples of partial coverage, facets,
// cracks and fillers, any lens points of one weight for all colours. It leaves to the CPU mirrors and glass, lens points that
// weigh colours or sides of the focus differently, cat-eyes and holdouts that stay sharp.
#pragma once

#include "dof/device/tile_device.h"
#include "gpu/device.h"

#include <memory>

namespace sparselens::gpu {

// Throws DeviceFailed. A device that fails later is left alone from then on: the CPU does what it has not done.
std::unique_ptr<TileDevice> open_lens_device(const DeviceInfo &info, const Watch &watch = {});

} // namespace sparselens::gpu
