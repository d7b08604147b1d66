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

// The values that the samples of one group have in common.
auto group_of(const BlockedSamples &samples, std::uint32_t i) {
    const int size = group_size(samples.coc[i]);
    const auto cell = [&](float v, double step) { return std::int64_t(std::floor(double(v) / step)); };
    return std::tuple(size, cell(samples.x[i], size), cell(samples.y[i], size),
                      cell(samples.depth(i), one_surface_px), size > 1 ? 0 : i);
}

} // namespace

HighlightGroups::HighlightGroups(const BlockedSamples &samples, std::span<const std::uint32_t> highlights) {
    const auto key = [&](std::uint32_t h) { return group_of(samples, highlights[h]); };
    for (const SampleBlock &block : samples.blocks) {
        of_block_.push_back(std::uint32_t(begin_.size()));
        const std::size_t first = members_.size();
        for (auto h = std::uint32_t(first); h < highlights.size() && highlights[h] < block.end; ++h)
            members_.push_back(h);
        const auto own = members_.begin() + std::ptrdiff_t(first);
        std::stable_sort(own, members_.end(), [&](auto a, auto b) { return key(a) < key(b); });
        for (std::size_t n = first; n < members_.size(); ++n)
            if (n == first || key(members_[n - 1]) != key(members_[n])) begin_.push_back(std::uint32_t(n));
    }
    of_block_.push_back(std::uint32_t(begin_.size()));
    begin_.push_back(std::uint32_t(members_.size()));
}

} // namespace sparselens
