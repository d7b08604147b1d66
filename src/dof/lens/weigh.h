// Adds what lens points see (see.h), weighted, to the sums of a tile.
//
// Samples of partial coverage are composited front to back, as independent coverages, over the opaque sample behind
// them; over a filler if there is no opaque sample. If the filler is unknown, too, they count by their coverage.
// `Light`, one of the types of lights.h, says how a lens point counts. It is a type because most lens points count
// alike for all channels.
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
    Opaque opaque_at(const Seen &seen, std::size_t cell) const;
    std::size_t side_of(std::uint64_t key) const;
    // The share of light that passes the holdout: from this depth, and from the opaque sample of the cell.
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
    std::span<const std::uint32_t> covered_; // the part in use: cells with partial samples
    // Sums over all lens points so far:
    std::vector<float> sums_;  // [group][pixel][4]
    std::vector<float> known_; // [group][pixel], of the picture
};

} // namespace sparselens
