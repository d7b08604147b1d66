// A GPU that turns views into samples (warp_land.comp and the kernels that follow it). It leaves to the CPU what fits
// into no buffer.
#pragma once

#include "gpu/device.h"
#include "warp/warp_device.h"

#include <memory>

namespace sparselens::gpu {

// Throws DeviceFailed, also if the device has no double precision. A device that fails later is not used again: the CPU
// does what it has not done.
std::unique_ptr<WarpDevice> open_warp_device(const DeviceInfo &info, const Watch &watch = {});

} // namespace sparselens::gpu
