// A GPU that gathers tiles of the lens picture (lens_tile.comp). It leaves to the CPU what fits into no buffer.
#pragma once

#include "dof/device/tile_device.h"
#include "gpu/device.h"

#include <memory>

namespace sparselens::gpu {

// Throws DeviceFailed. A device that fails later is left alone from then on: the CPU does what it has not done.
std::unique_ptr<TileDevice> open_lens_device(const DeviceInfo &info, const Watch &watch = {});

} // namespace sparselens::gpu
