// Gathers tiles of the lens gather on a device (lens_tile.comp). It leaves to the CPU tiles for which one lens point
// takes more turns of loops than the device allows.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/gather_scene.h"
#include "gpu/device_worker.h"
#include "gpu/lens/tile_lists.h"
#include "kernels/lens_rules.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace sparselens::gpu {

// A scene of the lens gather, laid out as lens_tile.comp reads it. It has all samples. It stays on the device while
// tiles are gathered from it, and data that a new frame does not change are not copied again.
struct SceneArrays {
    // Samples: first those of the LDI, then fillers, then solids. Solids have no alphas and no colours.
    std::vector<std::array<float, 2>> places;
    std::vector<std::uint32_t> uppers; // with lens_kernel::hiding except for fillers
    std::vector<float> cocs, alphas;
    std::vector<float> shown;   // CoCs of what samples show; empty without mirrors and glass: as `cocs`
    std::vector<float> colours; // [group][sample][4]
    std::vector<std::uint32_t> solids;      // the sample that each solid shows
    std::vector<std::uint32_t> facets;      // three samples each
    std::vector<lens_kernel::Block> blocks; // of samples, of fillers, of solids and of facets
    std::vector<std::uint32_t> sets;        // [channel]: its ColourSet
};

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
