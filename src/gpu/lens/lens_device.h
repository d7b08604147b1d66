// A GPU that gathers tiles of the lens picture (lens_tile.comp): all but those under a holdout that stays sharp, and what
// fits into no buffer, which it leaves to the CPU.
#pragma once

#include "dof/device/tile_device.h"
#include "gpu/device.h"

#include <memory>

namespace sparselens::gpu {

// Throws DeviceFailed. A device that fails later is left alone from then on: the CPU does what it has not done.
std::unique_ptr<TileDevice> open_lens_device(const DeviceInfo &info, const Watch &watch = {});

} // namespace sparselens::gpu
