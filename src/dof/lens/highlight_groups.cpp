#include "dof/lens/highlight_groups.h"

#include "dof/tuning.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sparselens {

namespace {

constexpr float group_of_coc = GatherTuning::lamp_group_of_coc;

// The size of a group, pixels: a power of two, so that groups do not change with every change of the focus; a block at
// most.
int group_size(float coc) {
    int size = 1;
    while (size < BlockedSamples::size && float(2 * size) <= group_of_coc * std::abs(coc)) size *= 2;
    return size;
}

// The values that the members of one group have in common.
auto key_of(const PlacedHighlights &highlights, std::uint32_t h) {
    const std::uint32_t i = highlights.sample[h];
    const int size = group_size(highlights.samples.coc[i]);
    const auto cell = [](float v, double step) { return std::int64_t(std::floor(double(v) / step)); };
    const Imath::V2f at = highlights.place(h);
    return std::tuple(size, cell(at.x, size), cell(at.y, size),
                      cell(highlights.samples.depth(i), one_surface_px), size > 1 ? 0 : h);
}

} // namespace

HighlightGroups::HighlightGroups(const PlacedHighlights &highlights) {
    const auto key = [&](std::uint32_t h) { return key_of(highlights, h); };
    // Makes groups of the members from `first` on.
    const auto group = [&](std::size_t first) {
        std::stable_sort(members_.begin() + std::ptrdiff_t(first), members_.end(),
                         [&](auto a, auto b) { return key(a) < key(b); });
        for (std::size_t n = first; n < members_.size(); ++n)
            if (n == first || key(members_[n - 1]) != key(members_[n])) begin_.push_back(std::uint32_t(n));
    };
    std::vector<std::uint32_t> on_the_move;
    std::uint32_t h = 0;
    for (const SampleBlock &block : highlights.samples.blocks) {
        of_block_.push_back(std::uint32_t(begin_.size()));
        const std::size_t first = members_.size();
        for (; h < highlights.sample.size() && highlights.sample[h] < block.end; ++h)
            (highlights.is_moved(h) ? on_the_move : members_).push_back(h);
        group(first);
    }
    of_block_.push_back(std::uint32_t(begin_.size()));
    const std::size_t first_moved = members_.size();
    members_.insert(members_.end(), on_the_move.begin(), on_the_move.end());
    group(first_moved);
    begin_.push_back(std::uint32_t(members_.size()));
    moved_.resize(begin_.size() - 1 - of_block_.back());
    for (std::size_t n = 0; n < moved_.size(); ++n)
        for (const std::uint32_t member : members(of_block_.back() + n)) {
            moved_[n].box.extendBy(highlights.place(member));
            moved_[n].coc =
                std::max(moved_[n].coc, std::abs(highlights.samples.coc[highlights.sample[member]]));
        }
}

} // namespace sparselens
