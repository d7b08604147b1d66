// A device, such as a GPU (gpu/gather/gather_device.h), that gathers tiles of a picture in place of the CPU. The lens
// gather prepares samples, fillers and lens points in the same way for both, and the selective gather prepares its
// splats. The CPU gathers the tiles that the device leaves.
#pragma once

#include "base/progress.h"
#include "kernels/lens_rules.h"
#include "lens/lens_samples.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace sparselens {

struct GatherScene; // dof/lens/gather_scene.h
struct SplatBlocks; // dof/selective/splats.h

// One tile of lens_tile_size pixels, and what it is gathered from.
struct TileTask {
    Imath::V2i origin;
    std::span<const std::uint32_t> samples, facets, fillers; // block numbers
    std::span<const LensSample> lens;
    std::span<const std::uint32_t> solids = {}; // block numbers
    // The pixels across and down that are asked for, from the tile's corner. A device may gather all pixels of the
    // tile.
    int size = lens_kernel::tile_size;
};

// The result of a tile: the mean over the lens points, for each pixel, row by row.
struct TilePicture {
    // Four channels per pixel; the next group of channels follows `group_step` values later. 0 where unknown.
    const float *values;
    // One number per pixel; the next group follows a quarter of `group_step` later. 0: nothing is known of the group.
    const float *known;
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

// A block of splats that can reach a tile.
struct VisitedBlock {
    std::uint32_t block;
    bool covers;   // each of its discs covers the whole tile
    bool ends_bin; // the next block that the tile visits lies in another depth bin
};

// What the selective gather gathers tiles from.
struct SplatScene {
    const SplatBlocks &splats;
    Imath::Box2i data; // window
    double pixel_aspect;
    std::size_t layers; // the largest number of layers of a pixel
};

struct SplatTask {
    Imath::Box2i tile;                    // its pixels, in the data window
    std::span<const VisitedBlock> blocks; // front to back
};

// The result of a tile. Its pixels are counted row by row, splat_kernel::size in a row.
struct SplatPicture {
    // Four colours per pixel; the next group of colours follows `group_step` values later.
    const float *values;
    const float *alphas; // one per pixel
    std::size_t group_step;

    float value(std::size_t pixel, std::size_t colour) const {
        return values[colour / 4 * group_step + pixel * 4 + colour % 4];
    }
};

using TileReport = DeviceReport; // of tiles

class TileDevice {
public:
    TileDevice() = default;
    TileDevice(const TileDevice &) = delete;
    TileDevice &operator=(const TileDevice &) = delete;
    virtual ~TileDevice() = default;

    // Gathers the tasks that it can, and calls done(task, picture) once for each of them, from any thread.
    virtual void gather(const GatherScene &scene, std::span<const TileTask> tasks,
                        const std::function<void(std::size_t task, const TilePicture &)> &done) = 0;
    // The same for tiles of the selective gather.
    virtual void gather(const SplatScene &scene, std::span<const SplatTask> tasks,
                        const std::function<void(std::size_t task, const SplatPicture &)> &done) = 0;
    virtual TileReport take_report() = 0;
};

} // namespace sparselens
