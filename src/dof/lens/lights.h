// How a lens point counts at the pixels of a tile, and how much is known there.
//
// A lens point that sees something unknown is left out, and the weights of the others are renormalised. For this, the
// known weight is summed up beside the light. These types are arguments of Weigh (weigh.h).
#pragma once

#include "base/float4.h"
#include "dof/lens/see.h"

#include <array>
#include <cstddef>
#include <vector>

namespace sparselens {

// The partial samples of a pixel in front of an opaque one, for four channels.
struct Covered {
    std::array<Float4, 2> over; // [side]: the sum of their colours
    float taken;                // share of the light behind them that they hide
    Float4 behind;              // its colour; 0 where it is unknown
    std::size_t side;           // on which the opaque one lies
};

// Lens points that count alike for all channels, pixels and sides of the focus.
class EvenLight {
public:
    static constexpr std::size_t sides = 1;

    explicit EvenLight(const GatherScene &) : unknown_(tile_cells::pixels) {}

    // Counts a lens point as known, and behind focus, in all pixels that see through it. The calls that follow are for
    // this lens point.
    void count(const LensSample &point, const Seen &) { total_ += weight_ = point.weight; }
    // The factors on light of a group of channels.
    Float4 of(std::size_t, std::size_t) const { return Float4{} + weight_; }
    Float4 with(Float4 sum, std::size_t, const Covered &c) const {
        return sum + weight_ * (c.over[0] - c.taken * c.behind);
    }
    // A share of the lens point is unknown at a pixel of the tile.
    void lose(std::size_t pixel, float share) { unknown_[pixel] += share * weight_; }
    // A share of the lens point is in front of focus.
    void put_in_front(std::size_t, float) {}

    // The weight of known light over all lens points; 0: nothing is known. [group][pixel][4].
    std::vector<float> known(std::size_t groups) const;

private:
    float total_ = 0, weight_ = 0;
    std::vector<float> unknown_; // [pixel]
};

// Lens points that count differently for R, G and B, or that not all pixels see through; with two `sides`, they also
// count differently for what lies behind focus (0) and in front of it (1).
template <std::size_t sides_>
class ChannelLight {
public:
    static constexpr std::size_t sides = sides_;

    explicit ChannelLight(const GatherScene &scene);

    void count(const LensSample &point, const Seen &seen);
    Float4 of(std::size_t group, std::size_t side) const { return load4(&light_[side][group * 4]); }
    Float4 with(Float4 sum, std::size_t group, const Covered &c) const {
        for (std::size_t side = 0; side < sides; ++side) sum += of(group, side) * c.over[side];
        return sum - c.taken * of(group, c.side) * c.behind;
    }
    void lose(std::size_t pixel, float share);
    void put_in_front(std::size_t pixel, float share);

    std::vector<float> known(std::size_t groups) const;

private:
    void weigh_channels(const LensSample &point);

    const GatherScene &scene_;
    float total_ = 0;
    // For the lens point, [side][channel]: the factor on light, and its weight in the divisor of the sum.
    std::array<std::vector<float>, 2> light_, weight_;
    // [group][row][column][4]: how much more weight the pixels from that column on see.
    std::vector<double> steps_;
    // [group][pixel][4]: the part of that weight that is unknown.
    std::vector<double> lost_;
    // [group][pixel][4], if there are two sides: how much more weight, because a part of it is in front.
    std::vector<float> in_front_;
};

} // namespace sparselens
