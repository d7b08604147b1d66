// One tile of the lens picture: every lens point sees its own picture of the samples, each a square one pixel
// wide and high, the nearest opaque one in front; the mean over the lens points is the tile.
//
// Samples of partial coverage are composited front to back over the opaque one behind them. A lens point that
// meets nothing opaque sees what lies behind as unknown: only the light in front of it counts, and the weights
// are renormalised. lens_gather_reference.h says the same slowly.
#pragma once

#include "dof/sample_blocks.h"
#include "lens/lens_samples.h"

#include <Imath/ImathBox.h>

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// Colours of the samples of a BlockedSamples, in groups of four channels: [group][sample][4], premultiplied.
struct SampleColours {
    std::size_t groups = 0;
    std::vector<float> values;
    std::span<const float> group(std::size_t g, std::size_t count) const {
        return std::span(values).subspan(g * count * 4, count * 4);
    }
};

class LensTile {
public:
    static constexpr int size = 64; // pixels wide and high: the buffers of a lens point stay in the cache

    LensTile(const BlockedSamples &samples, const SampleColours &colours);

    // Gathers the pixels [origin, origin + size), relative to the data window's corner like the samples, from
    // the blocks that can reach them.
    void gather(const Imath::V2i &origin, std::span<const std::uint32_t> blocks, std::span<const LensSample> lens);

    // Sum of the colours of the known lens points at a pixel of the tile, and of their weights.
    std::span<const float> sum(int x, int y, std::size_t group) const;
    float weight(int x, int y) const { return weights_[std::size_t(y * size + x)]; }

private:
    // The buffers have a border of one cell that takes what falls outside.
    static constexpr int stride = size + 2;

    void see_opaque(const LensSample &lens);
    void see_partial(const LensSample &lens);
    void add_picture(float weight);
    void add_picture_under_partial(float weight);

    const BlockedSamples &samples_;
    const SampleColours &colours_;
    float origin_x_ = 0, origin_y_ = 0;
    std::vector<std::uint32_t> blocks_;
    std::vector<std::uint32_t> partial_;  // samples of partial coverage, front to back
    std::vector<std::uint64_t> front_;    // [cell]: depth and sample of the nearest opaque one; 0: none
    std::vector<float> transmittance_;    // [cell]: of the partial samples in front
    std::vector<float> over_;             // [group][cell][4]: their colours
    std::vector<float> sums_;             // [group][pixel][4]
    std::vector<float> weights_;          // [pixel]
};

} // namespace sparselens
