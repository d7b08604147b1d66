// Lists of what may cast shadows on wide discs, made once for all tiles of a picture: a disc reaches many tiles, and
// few of the blocks in front of it are near enough to its light's path.
#pragma once

#include "dof/lens/highlights.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/shadow_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <vector>

namespace sparselens {

class ShadowLists {
public:
    // Lists for groups of highlights among these samples.
    ShadowLists(const Highlights &highlights, const BlockedSamples &samples);

    // Returns the list of the group with this first member. The first call, by any thread, takes it from find(). Null:
    // the disc of the group is small, or the list is too long to be kept.
    template <typename Find>
    const std::vector<CastingBlock> *of(std::uint32_t first_member, const Find &find) const;

private:
    struct List {
        std::once_flag found;
        std::vector<CastingBlock> blocks;
        bool kept = false;
    };
    static constexpr std::uint32_t none = 0xffffffffu;
    // [highlight]: the number of its group's list if it is the first of the group; or none
    std::vector<std::uint32_t> number_;
    std::size_t longest_ = 0;
    mutable std::vector<List> lists_;
};

template <typename Find>
const std::vector<CastingBlock> *ShadowLists::of(std::uint32_t first_member, const Find &find) const {
    if (number_[first_member] == none) return nullptr;
    List &list = lists_[number_[first_member]];
    std::call_once(list.found, [&] {
        std::vector<CastingBlock> blocks = find();
        list.kept = blocks.size() <= longest_;
        if (list.kept) list.blocks = {blocks.begin(), blocks.end()}; // without spare capacity
    });
    return list.kept ? &list.blocks : nullptr;
}

} // namespace sparselens
