// How much of what a lens point may see beside a sample is as bright as it.
//
// A lamp is rare: few lens points see it, so that their mean is noise. What covers a fifth of what they see or more
// is a bright surface, which they see well (n of them with a relative deviation of sqrt((1 / share - 1) / n) at most), however
// dark it is beside it.
#pragma once

#include "base/grid.h"
#include "dof/lens/sample_blocks.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace sparselens {

class BrightShare {
public:
    static constexpr int cell = 4; // blocks wide and high, as highlights look at them

    BrightShare(const BlockedSamples &samples, const std::function<float(std::uint32_t sample)> &brightness);

    // The share, [0, 1], of the samples within a cell's width of one, across and down, that are half as bright or brighter. It changes
    // continuously with brightness and place: those from a quarter to all of it count in part.
    double around(std::uint32_t sample, float brightness) const;

private:
    static constexpr int octaves = 32; // of brightness, from 2^-16 on
    static int octave_of(float brightness);
    double count(int octave, const std::array<double, 4> &box) const;

    const BlockedSamples &samples_;
    Grid corners_; // of cells
    // [octave][corner]: how many before that corner are of that octave or brighter
    std::vector<std::uint32_t> below_;
};

} // namespace sparselens
