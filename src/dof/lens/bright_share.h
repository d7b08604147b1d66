// Which share of the samples around a sample is as bright as the sample.
//
// A lamp is rare: few lens points see it, so their mean is noisy. Something that covers a fifth or more of what they
// see is a bright surface, however dark its surroundings. Lens points see it well: n of them have a relative deviation
// of at most sqrt((1 / share - 1) / n).
#pragma once

#include "base/grid.h"
#include "dof/lens/sample_blocks.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace sparselens {

// How much a sample counts among those around it: by what it covers, so that many thin layers do not outvote the
// surface behind them. Light without coverage counts wholly.
inline float counts_as(const BlockedSamples &samples, std::uint32_t sample) {
    return samples.alpha[sample] > 0 ? samples.alpha[sample] : 1;
}

class BrightShare {
public:
    static constexpr int cell = 4; // blocks wide and high, like the cells of highlights.cpp

    BrightShare(const BlockedSamples &samples, const std::function<float(std::uint32_t sample)> &brightness);

    // Returns the share, [0, 1], of the samples within a cell's width of a sample, across and down, that are half as
    // bright or brighter. It changes continuously with brightness and position: samples from a quarter of the
    // brightness to all of it count in part.
    double around(std::uint32_t sample, float brightness) const;

private:
    static constexpr int octaves = 32; // of brightness, from 2^-16 on
    static int octave_of(float brightness);
    double count(int octave, const std::array<double, 4> &box) const;

    const BlockedSamples &samples_;
    Grid corners_; // of cells
    // [octave][corner]: what the samples to the left of the corner and above it count that are of this octave or
    // brighter
    std::vector<double> below_;
};

} // namespace sparselens
