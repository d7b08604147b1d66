// What lens points add to the sums of a tile: the colours of what each sees (see.h), weighted.
//
// Samples of partial coverage are composited front to back, as independent coverages, over what is opaque behind them: over a
// filler where nothing is, and where that is unknown, too, they count by their coverage. How a lens point counts is a type, as
// most count alike for all channels: `Light` is one of lights.h.
#pragma once

#include "dof/lens/held_out.h"
#include "dof/lens/lights.h"
#include "dof/lens/see.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

template <typename Light>
class Weigh {
public:
    // Begins a tile, before any lens point.
    Weigh(const GatherScene &scene, const Seen &tile);

    // Adds what a lens point sees.
    void add(const Seen &seen, const LensSample &point);

    // The mean over the known lens points; past a cat-eye, over those that it lets through, also where it darkens. It is
    // made of the sums: once, when all lens points are added.
    TilePicture picture();

private:
    // What is opaque in a cell, a filler included.
    struct Opaque {
        const float *colours; // the first group; none where it is unknown
        std::size_t group_step, side;

        Float4 colour(std::size_t group) const { return load4(colours + group * group_step); }
    };
    Opaque opaque_at(const Seen &seen, std::size_t cell) const;
    std::size_t side_of(std::uint64_t key) const;
    // How much the holdout lets pass of light from that depth, and of the light of the opaque sample there.
    float passes(const Seen &seen, std::size_t cell, float depth) const;
    float opaque_passes(const Seen &seen, std::size_t cell) const;
    void add_opaque(const Seen &seen);
    void add_fillers(const Seen &seen);
    void cover(const Seen &seen);
    template <typename Groups, typename Passes>
    void cover_by(const Seen &seen, Groups groups, const Passes &passed);
    void add_covered(const Seen &seen);
    void uncover();

    const GatherScene &scene_;
    HeldOut held_out_;
    Light light_;
    std::vector<float> partial_; // colours of the partial samples: [group][of each][4]
    // Partial samples of one lens point:
    std::vector<float> left_;     // [cell]: what they leave of the light behind them
    std::vector<float> over_;     // [side][group][cell][4]: their colours
    std::vector<float> in_front_; // [cell]: what those in front of focus hide, if the light has two sides
    std::vector<std::uint32_t> covered_cells_;
    std::span<const std::uint32_t> covered_; // of those: where there are any
    // Sums over all lens points so far:
    std::vector<float> sums_;  // [group][pixel][4]
    std::vector<float> known_; // [group][pixel], of the picture
};

} // namespace sparselens
