// A device that gathers tiles of a picture instead of the CPU: a GPU (gpu/gather/gather_device.h). The lens gather
// prepares samples, fillers and lens points for both alike, the selective gather its splats (splat_tiles.h); each
// gathers itself what the device leaves.
#pragma once

#include "base/device_report.h"
#include "dof/device/splat_tiles.h"
#include "kernels/lens_layout.h"
#include "lens/lens_samples.h"

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace sparselens {

struct GatherScene; // dof/lens/gather_scene.h

// One tile of lens_tile_size pixels, and what it is gathered from.
struct TileTask {
    Imath::V2i origin;
    std::span<const std::uint32_t> samples, facets, fillers; // blocks of them
    std::span<const LensSample> lens;
    std::span<const std::uint32_t> solids = {}; // blocks of them, too
    // Pixels across and down that are asked for, from its corner; a device may gather all.
    int size = lens_kernel::tile_size;
};

// What a tile has gathered: the mean over the lens points of each pixel, row by row.
struct TilePicture {
    const float
        *values; // four channels of each pixel, those of the next group `group_step` values later; 0: unknown
    const float *
        known; // of each pixel, those of the next group a quarter of that later; 0: nothing is known of the group
    std::size_t groups, group_step;

    float value(std::size_t pixel, std::size_t channel) const {
        return values[channel / 4 * group_step + pixel * 4 + channel % 4];
    }
    bool is_known(std::size_t pixel) const {
        for (std::size_t g = 0; g < groups; ++g)
            if (known[g * group_step / 4 + pixel] > 0) return true;
        return false;
    }
};

using TileReport = DeviceReport; // of tiles

class TileDevice {
public:
    TileDevice() = default;
    TileDevice(const TileDevice &) = delete;
    TileDevice &operator=(const TileDevice &) = delete;
    virtual ~TileDevice() = default;

    // Gathers those of the tasks that it can: calls done(task, picture) for each of them, by any thread, once.
    virtual void gather(const GatherScene &scene, std::span<const TileTask> tasks,
                        const std::function<void(std::size_t task, const TilePicture &)> &done) = 0;
    // The same for tiles of the selective gather.
    virtual void gather(const SplatScene &scene, std::span<const SplatTask> tasks,
                        const std::function<void(std::size_t task, const SplatPicture &)> &done) = 0;
    virtual TileReport take_report() = 0;
};

} // namespace sparselens
