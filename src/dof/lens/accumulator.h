// Adds what lens points see (visibility.h), weighted, to the sums of a tile.
//
// Samples of partial coverage are composited front to back, as independent coverages, over the opaque sample or filler
// behind them. If what is behind them is unknown, they count by their coverage.
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

// How lens points count at the pixels of a tile, and how much is known there. They may count differently for R, G and
// B, and for what lies behind focus (side 0) and in front of it (1). `l`: the number of a lens point
// among those that are added at once.
//
// A lens point that sees something unknown is left out, and the weights of the others are renormalised. For this, the
// known weight is summed up beside the light.
class LensWeights {
public:
    explicit LensWeights(const GatherScene &scene);

    // Counts a lens point as known, and behind focus, in all pixels. The calls that follow are for the lens points
    // counted last.
    void count(std::size_t l, const LensSample &point);
    // The factors on light of a group of channels.
    Float4 of(std::size_t l, std::size_t group, std::size_t side) const {
        return load4(&light_[l][side][group * 4]);
    }
    // A share of the lens point is unknown at a pixel of the tile.
    void lose(std::size_t l, std::size_t pixel, float share);
    // A share of the lens point is in front of focus.
    void put_in_front(std::size_t l, std::size_t pixel, float share);

    // The weight of known light over all lens points; 0: nothing is known. [group][pixel][4].
    std::vector<float> known() const;

private:
    const GatherScene &scene_;
    float total_ = 0;
    // [lens point][side][channel]: the factor on light, and its weight in the divisor of the sum.
    std::array<std::array<std::vector<float>, 2>, points_at_once> light_, weight_;
    std::vector<float> totals_; // [channel]: the sum of the weights behind focus
    // [group][pixel][4]: how much less is known, because a part is unknown, or in front of focus.
    std::vector<float> lost_;
};

class Accumulator {
public:
    // Begins a tile, before any lens point. `two_sided`: lens points count differently behind focus and in front of it.
    Accumulator(const GatherScene &scene, const TileSamples &samples, const Imath::V2i &origin,
                bool two_sided);

    // Adds what a lens point sees. `seen` must not change until points_at_once more are added.
    void add(const Visibility &seen, const LensSample &point);

    // Returns the mean over the known lens points. Past a cat-eye, it is the mean over those that it lets through, even
    // where it darkens. The sums are overwritten: call this once, when all lens points are added.
    TilePicture picture();

private:
    // The share of light that passes the holdout: from this depth, and from the opaque sample or filler of the cell.
    float passes(std::size_t cell, float depth) const;
    float opaque_passes(const Visibility &seen, std::size_t cell) const;
    Float4 colour(std::size_t group, std::uint32_t number) const {
        return load4(&samples_.colours(group)[std::size_t(number) * 4]);
    }
    std::size_t side_of(std::uint32_t number) const {
        return sides_ > 1 && samples_.in_front[number] ? 1 : 0;
    }
    void add_opaque();
    void add_row(std::size_t l, const Visibility &seen, std::size_t group, int y);
    void cover(const Visibility &seen);
    template <typename Groups, typename Passes>
    void cover_by(const Visibility &seen, Groups groups, const Passes &passed);
    void add_covered(std::size_t l, const Visibility &seen);
    void uncover();

    const TileSamples &samples_;
    Imath::V2i origin_; // the tile's first pixel, relative to the data window's corner
    HoldoutLookup held_out_;
    std::size_t sides_, groups_; // of focus, and of four channels
    LensWeights weights_;
    // Lens points whose opaque samples are not added yet.
    std::array<const Visibility *, points_at_once> waiting_;
    std::size_t waiting_count_ = 0;
    std::vector<float> partial_; // colours of the partial samples: [group][of each][4]
    // Partial samples of one lens point:
    std::vector<float> left_;     // [cell]: what they leave of the light behind them
    std::vector<float> over_;     // [side][group][cell][4]: their colours
    std::vector<float> in_front_; // [cell]: what those in front of focus hide, if there are two sides
    std::vector<std::uint32_t> covered_cells_;
    std::span<const std::uint32_t> covered_; // the part in use: cells with partial samples
    // Sums over all lens points so far:
    std::vector<float> sums_;  // [group][pixel][4]
    std::vector<float> known_; // [group][pixel], of the picture
};

} // namespace sparselens
