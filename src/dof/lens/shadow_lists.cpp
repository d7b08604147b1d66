#include "dof/lens/shadow_lists.h"

#include "dof/lens/lens_tiles.h"

#include <span>

namespace sparselens {

namespace {

constexpr float wide = lens_tile_size / 2;   // pixels of CoC, from which on a disc reaches several tiles
constexpr std::size_t all_blocks = 2u << 20; // in all lists: 64 MB
constexpr std::size_t longest_of_many = 64;  // blocks

} // namespace

ShadowLists::ShadowLists(const Highlights &highlights, const BlockedSamples &samples)
    : number_(highlights.sample.size(), none) {
    std::uint32_t lists = 0;
    if (highlights.sample.empty()) return;
    const auto number = [&](std::span<const std::uint32_t> group) {
        const std::uint32_t first = group.front();
        if (std::abs(samples.coc[highlights.sample[first]]) >= wide) number_[first] = lists++;
    };
    for (std::uint32_t b = 0; b < samples.blocks.size(); ++b) highlights.groups.for_each(b, number);
    Imath::Box2f all;
    all.makeInfinite();
    highlights.groups.for_each_moved(all, 1, number);
    lists_ = std::vector<List>(lists);
    longest_ = std::max(longest_of_many, all_blocks / std::max<std::size_t>(lists, 1));
}

} // namespace sparselens
