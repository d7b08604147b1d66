// A build without the kernels for GPUs (SPARSELENS_GPU) has no devices.
#include "gpu/gather/gather_device.h"
#include "gpu/warp/warp_device.h"

namespace sparselens::gpu {

std::vector<DeviceInfo> list_devices(std::string *why_none) {
    if (why_none) *why_none = "this build has no kernels for GPUs";
    return {};
}

std::unique_ptr<TileDevice> open_gather_device(const DeviceInfo &info, const Watch &) {
    throw DeviceFailed(info.name + " cannot be used: this build has no kernels for GPUs");
}

std::unique_ptr<WarpDevice> open_warp_device(const DeviceInfo &info, const Watch &) {
    throw DeviceFailed(info.name + " cannot be used: this build has no kernels for GPUs");
}

} // namespace sparselens::gpu
