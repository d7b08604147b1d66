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

// The highlights that are grouped.
struct Grouped {
    const BlockedSamples &samples;
    std::span<const std::uint32_t> sample;
    std::span<const Imath::V2f> moved;

    bool is_moved(std::uint32_t h) const { return !moved.empty() && moved[h] != Imath::V2f(0, 0); }
    Imath::V2f place(std::uint32_t h) const {
        const Imath::V2f at(samples.x[sample[h]], samples.y[sample[h]]);
        return is_moved(h) ? at + moved[h] : at;
    }
    // The values that the members of one group have in common.
    auto key(std::uint32_t h) const {
        const std::uint32_t i = sample[h];
        const int size = group_size(samples.coc[i]);
        const auto cell = [](float v, double step) { return std::int64_t(std::floor(double(v) / step)); };
        const Imath::V2f at = place(h);
        return std::tuple(size, cell(at.x, size), cell(at.y, size), cell(samples.depth(i), one_surface_px),
                          size > 1 ? 0 : h);
    }
};

} // namespace

HighlightGroups::HighlightGroups(const BlockedSamples &samples, std::span<const std::uint32_t> highlights,
                                 std::span<const Imath::V2f> moved) {
    const Grouped grouped{samples, highlights, moved};
    // Makes groups of the members from `first` on.
    const auto group = [&](std::size_t first) {
        std::stable_sort(members_.begin() + std::ptrdiff_t(first), members_.end(),
                         [&](auto a, auto b) { return grouped.key(a) < grouped.key(b); });
        for (std::size_t n = first; n < members_.size(); ++n)
            if (n == first || grouped.key(members_[n - 1]) != grouped.key(members_[n]))
                begin_.push_back(std::uint32_t(n));
    };
    std::vector<std::uint32_t> on_the_move;
    std::uint32_t h = 0;
    for (const SampleBlock &block : samples.blocks) {
        of_block_.push_back(std::uint32_t(begin_.size()));
        const std::size_t first = members_.size();
        for (; h < highlights.size() && highlights[h] < block.end; ++h)
            (grouped.is_moved(h) ? on_the_move : members_).push_back(h);
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
            moved_[n].box.extendBy(grouped.place(member));
            moved_[n].coc = std::max(moved_[n].coc, std::abs(samples.coc[highlights[member]]));
        }
}

} // namespace sparselens
