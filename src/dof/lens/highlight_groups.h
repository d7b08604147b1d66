// Highlights that are shadowed together (highlight_shadows.h): samples of one surface and one block, within a square of
// 1/16 of their CoC. A sample near the focus is alone.
#pragma once

#include "dof/lens/sample_blocks.h"
#include "dof/tuning.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

// Where highlights are. A highlight is given by its index in `sample`.
struct PlacedHighlights {
    const BlockedSamples &samples;
    std::span<const std::uint32_t> sample; // of each highlight, ascending
    std::span<const Imath::V2f> moved;     // how far each is from its sample, pixels; empty: none is moved

    bool is_moved(std::uint32_t highlight) const {
        return !moved.empty() && moved[highlight] != Imath::V2f(0, 0);
    }
    Imath::V2f place(std::uint32_t highlight) const { // relative to the data window's corner
        const Imath::V2f at(samples.x[sample[highlight]], samples.y[sample[highlight]]);
        return moved.empty() ? at : at + moved[highlight];
    }
};

class HighlightGroups {
public:
    HighlightGroups() = default;
    // Each highlight is in one group.
    explicit HighlightGroups(const PlacedHighlights &highlights);

    // Calls visit(group) for the groups of a block that are not moved. A group lists the indices of its members in
    // `highlights`.
    template <typename Visit>
    void for_each(std::uint32_t block, const Visit &visit) const {
        for (std::uint32_t g = of_block_[block]; g < of_block_[block + 1]; ++g) visit(members(g));
    }
    // Calls visit(group) for the groups that are moved and whose light may reach these pixels. `extent`: of the
    // aperture, pixels per pixel of CoC.
    template <typename Visit>
    void for_each_moved(const Imath::Box2f &pixels, double extent, const Visit &visit) const {
        for (std::size_t n = 0; n < moved_.size(); ++n) {
            const Imath::V2f reach(float(double(moved_[n].coc) * extent) +
                                   GatherTuning::lamp_square_reach_px);
            if (pixels.intersects(Imath::Box2f(moved_[n].box.min - reach, moved_[n].box.max + reach)))
                visit(members(of_block_.back() + n));
        }
    }

private:
    struct Moved {
        Imath::Box2f box; // that the members lie in
        float coc = 0;    // the largest, without its sign
    };
    std::span<const std::uint32_t> members(std::size_t g) const {
        return std::span(members_).subspan(begin_[g], begin_[g + 1] - begin_[g]);
    }

    std::vector<std::uint32_t> members_;  // group after group
    std::vector<std::uint32_t> begin_;    // [group]: where its members begin; one entry more than groups
    std::vector<std::uint32_t> of_block_; // [block]: its first group; one entry more than blocks
    std::vector<Moved> moved_;            // the groups that follow those of the blocks
};

} // namespace sparselens
