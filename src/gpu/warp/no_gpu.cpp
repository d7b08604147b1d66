// A build without the kernels for GPUs (SPARSELENS_GPU) has no device.
#include "gpu/warp/warp_device.h"

namespace sparselens::gpu {

std::unique_ptr<WarpDevice> open_warp_device(const DeviceInfo &info, const Watch &) {
    throw DeviceFailed(info.name + " cannot be used: this build has no kernels for GPUs");
}

} // namespace sparselens::gpu
