// Gathers tiles of the selective gather on a device (selective_tile.comp). It leaves all tiles to the CPU if the device
// has no numbers of 64 bits.
#pragma once

#include "dof/device/tile_device.h"
#include "gpu/device_worker.h"

#include <map>
#include <vector>

namespace sparselens::gpu {

struct SplatLists;

class SelectiveTilesOnDevice {
public:
    explicit SelectiveTilesOnDevice(DeviceWorker &worker) : worker_(worker) {}

    // Like TileDevice::gather(). Throws DeviceFailed; what was done before stays done.
    void gather(const SplatScene &scene, std::span<const SplatTask> tasks,
                const std::function<void(std::size_t, const SplatPicture &)> &done);

private:
    const Program &program_for(std::size_t colours);
    void gather_stripe(const SplatScene &scene, const SplatLists &lists,
                       const std::function<void(std::size_t, const SplatPicture &)> &done);

    DeviceWorker &worker_;
    std::map<std::size_t, Program> programs_;   // by the number of colours; made when they are first needed
    std::vector<Buffer> splats_, lists_, made_; // in the order of the bindings; kept for later pictures
};

} // namespace sparselens::gpu
