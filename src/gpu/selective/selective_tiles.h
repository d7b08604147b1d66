// Gathers tiles of the selective gather on a device (selective_tile.comp). It leaves to the CPU splats that are more
// than a buffer holds, and all tiles if the device has no numbers of 64 bits.
#pragma once

#include "dof/device/tile_device.h"
#include "gpu/device_worker.h"

#include <optional>

namespace sparselens::gpu {

class SelectiveTilesOnDevice {
public:
    explicit SelectiveTilesOnDevice(DeviceWorker &worker) : worker_(worker) {}

    // Like TileDevice::gather(). Throws DeviceFailed; what was done before stays done.
    void gather(const SplatScene &scene, std::span<const SplatTask> tasks,
                const std::function<void(std::size_t, const SplatPicture &)> &done);

private:
    DeviceWorker &worker_;
    std::optional<Program> program_; // made when it is first needed
};

} // namespace sparselens::gpu
