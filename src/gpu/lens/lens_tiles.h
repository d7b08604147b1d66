// Gathers tiles of the lens gather on a device (lens_tile.comp). It leaves to the CPU tiles for which one lens point
// takes more turns of loops than the device allows.
#pragma once

#include "dof/device/tile_device.h"
#include "gpu/device_worker.h"
#include "gpu/lens/scene_arrays.h"
#include "gpu/lens/tile_lists.h"

#include <array>
#include <map>
#include <vector>

namespace sparselens::gpu {

// Arrays that are in buffers of a device, in the order of parts_of(). New arrays are compared with those before, and
// only what differs is copied. In a pull of focus over one LDI, the positions, depths and coverages of samples stay the
// same, and most of their colours. The caller need not say whether it is the same LDI.
template <class Arrays>
struct OnDevice {
    Arrays arrays;
    std::vector<Buffer> buffers;
};

class LensTilesOnDevice {
public:
    explicit LensTilesOnDevice(DeviceWorker &worker) : worker_(worker), device_(worker.device) {}

    // Like TileDevice::gather(). Throws DeviceFailed; what was done before stays done.
    void gather(const GatherScene &scene, std::span<const TileTask> tasks,
                const std::function<void(std::size_t, const TilePicture &)> &done);

private:
    const Program &program_for(std::uint32_t rules, std::uint32_t points);
    template <class Arrays>
    void bring(OnDevice<Arrays> &there, Arrays arrays);
    void gather_stripe(const GatherScene &scene, const Program &program, const OnDevice<SceneArrays> &from,
                       const std::function<void(std::size_t, const TilePicture &)> &done);

    DeviceWorker &worker_;
    Device &device_;
    std::map<std::uint32_t, Program> programs_;   // by their rules; made when they are first needed
    std::array<OnDevice<SceneArrays>, 2> scenes_; // the picture's, and the last coarse one
    OnDevice<TileLists> lists_;                   // of the last stripe
    std::vector<Buffer> made_;                    // its results: values, what is known, sums between passes
};

} // namespace sparselens::gpu
