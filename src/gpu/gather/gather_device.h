// A GPU that gathers tiles of pictures for the lens gather (gpu/lens) and the selective gather (gpu/selective).
#pragma once

#include "dof/device/tile_device.h"
#include "gpu/device.h"

#include <memory>

namespace sparselens::gpu {

// Throws DeviceFailed. A device that fails later is not used again: the CPU does what it has not done.
std::unique_ptr<TileDevice> open_gather_device(const DeviceInfo &info, const Watch &watch = {});

} // namespace sparselens::gpu
