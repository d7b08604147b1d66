// Adds what lens points see (visibility.h), weighted, to the sums of a tile.
//
// Samples of partial coverage are composited front to back, as independent coverages, over the opaque sample behind
// them; over a filler if there is no opaque sample. If the filler is unknown, too, they count by their coverage.
// `Light`, one of the types below, says how a lens point counts. It is a type because most lens points count
// alike for all channels.
#pragma once

#include "base/numbers.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/visibility.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// How a lens point counts at the pixels of a tile, and how much is known there.
//
// A lens point that sees something unknown is left out, and the weights of the others are renormalised. For this, the
// known weight is summed up beside the light. These types are arguments of Accumulator.

// The partial samples of a pixel in front of an opaque one, for four channels.
struct Covered {
    std::array<Float4, 2> over; // [side]: the sum of their colours
    float taken;                // share of the light behind them that they hide
    Float4 behind;              // its colour; 0 where it is unknown
    std::size_t side;           // on which the opaque one lies
};

// Lens points that count alike for all channels, pixels and sides of the focus.
class UniformWeights {
public:
    static constexpr std::size_t sides = 1;

    explicit UniformWeights(const GatherScene &) : unknown_(tile_cells::pixels) {}

    // Counts a lens point as known, and behind focus, in all pixels that see through it. The calls that follow are for
    // this lens point.
    void count(const LensSample &point, const Visibility &) { total_ += weight_ = point.weight; }
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
class ChannelWeights {
public:
    static constexpr std::size_t sides = sides_;

    explicit ChannelWeights(const GatherScene &scene);

    void count(const LensSample &point, const Visibility &seen);
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

template <typename Light>
class Accumulator {
public:
    // Begins a tile, before any lens point.
    Accumulator(const GatherScene &scene, const Visibility &tile);

    // Adds what a lens point sees.
    void add(const Visibility &seen, const LensSample &point);

    // Returns the mean over the known lens points. Past a cat-eye, it is the mean over those that it lets through, even
    // where it darkens. The sums are overwritten: call this once, when all lens points are added.
    TilePicture picture();

private:
    // The opaque sample or the filler of a cell.
    struct Opaque {
        const float *colours; // the first group; null if unknown
        std::size_t group_step, side;

        Float4 colour(std::size_t group) const { return load4(colours + group * group_step); }
    };
    Opaque opaque_at(const Visibility &seen, std::size_t cell) const;
    std::size_t side_of(std::uint64_t key) const;
    // The share of light that passes the holdout: from this depth, and from the opaque sample of the cell.
    float passes(const Visibility &seen, std::size_t cell, float depth) const;
    float opaque_passes(const Visibility &seen, std::size_t cell) const;
    void add_opaque(const Visibility &seen);
    void add_fillers(const Visibility &seen);
    void cover(const Visibility &seen);
    template <typename Groups, typename Passes>
    void cover_by(const Visibility &seen, Groups groups, const Passes &passed);
    void add_covered(const Visibility &seen);
    void uncover();

    const GatherScene &scene_;
    HoldoutLookup held_out_;
    Light light_;
    std::vector<float> partial_; // colours of the partial samples: [group][of each][4]
    // Partial samples of one lens point:
    std::vector<float> left_;     // [cell]: what they leave of the light behind them
    std::vector<float> over_;     // [side][group][cell][4]: their colours
    std::vector<float> in_front_; // [cell]: what those in front of focus hide, if the light has two sides
    std::vector<std::uint32_t> covered_cells_;
    std::span<const std::uint32_t> covered_; // the part in use: cells with partial samples
    // Sums over all lens points so far:
    std::vector<float> sums_;  // [group][pixel][4]
    std::vector<float> known_; // [group][pixel], of the picture
};

} // namespace sparselens
