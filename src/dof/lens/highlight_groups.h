// Highlights that are shadowed together (highlight_shadows.h): samples of one surface and one block, within a square of
// 1/16 of their CoC. A sample near the focus is alone.
#pragma once

#include "dof/lens/sample_blocks.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

class HighlightGroups {
public:
    HighlightGroups() = default;
    // `highlights`: samples, ascending. Each is in one group.
    HighlightGroups(const BlockedSamples &samples, std::span<const std::uint32_t> highlights);

    // Calls visit(group) for the groups of a block. A group lists the indices of its members in `highlights`.
    template <typename Visit>
    void for_each(std::uint32_t block, const Visit &visit) const {
        for (std::uint32_t g = of_block_[block]; g < of_block_[block + 1]; ++g)
            visit(std::span(members_).subspan(begin_[g], begin_[g + 1] - begin_[g]));
    }

private:
    std::vector<std::uint32_t> members_;  // group after group
    std::vector<std::uint32_t> begin_;    // [group]: where its members begin; one entry more than groups
    std::vector<std::uint32_t> of_block_; // [block]: its first group; one entry more than blocks
};

} // namespace sparselens
