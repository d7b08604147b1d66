// Who gathers tiles of the lens picture in place of the CPU: a GPU (gpu/lens/lens_device.h). The lens gather prepares samples,
// fillers and lens points for both alike, and gathers itself what the device leaves.
#pragma once

#include "lens/lens_samples.h"

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct BlockedSamples;
struct SampleColours;
struct FillerSamples;
struct PlacedFacets;

// One tile of LensTile::size pixels, and what LensTile::gather() is given for it.
struct TileTask {
    Imath::V2i origin;
    std::span<const std::uint32_t> samples, facets, fillers; // blocks of them
    std::span<const LensSample> lens;
};

struct TileScene {
    const BlockedSamples &samples;
    const SampleColours &colours;
    const FillerSamples &fillers;
    const PlacedFacets &facets;
    bool held_out = false; // by a holdout that stays sharp
    bool cat_eye = false;  // whether pixels see through some lens points alone
};

// What a tile has gathered: of each pixel, row by row, sums over the lens points, and the weight of what is known of it.
struct TileSums {
    const float *light; // four channels of each pixel, those of the next group `group_step` later
    std::size_t group_step;
    const float *known; // 0: nothing is

    float value(std::size_t pixel, std::size_t channel) const { // 0 where nothing is known
        const float sum = light[channel / 4 * group_step + pixel * 4 + channel % 4];
        return known[pixel] > 0 ? sum / known[pixel] : 0;
    }
};

// What a device did since the report was last taken.
struct TileReport {
    std::size_t on_device = 0;                      // tiles
    std::map<std::string, std::size_t> on_cpu = {}; // tiles left to the CPU, by why, in a few words
    std::string failure = {}; // if not empty: it failed, and this says how; the CPU did the rest
};

class TileDevice {
public:
    TileDevice() = default;
    TileDevice(const TileDevice &) = delete;
    TileDevice &operator=(const TileDevice &) = delete;
    virtual ~TileDevice() = default;

    // Gathers those of the tasks that it can: calls done(task, sums) for each of them, by any thread, once.
    virtual void gather(const TileScene &scene, std::span<const TileTask> tasks,
                        const std::function<void(std::size_t task, const TileSums &)> &done) = 0;
    virtual TileReport take_report() = 0;
};

} // namespace sparselens
