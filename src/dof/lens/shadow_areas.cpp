#include "dof/lens/shadow_areas.h"

#include "base/grid.h"

#include <algorithm>
#include <limits>

namespace sparselens {

namespace {

constexpr std::size_t most_steps = 16;
constexpr float of_edges =
    0.5f; // pixels: by how much the CoC of an edge differs from that of its sample, at most

} // namespace

ShadowAreas::ShadowAreas(const BlockedSamples &samples)
    : samples_(samples), columns_(pieces_of(samples.columns, size)),
      made_(std::size_t(columns_) * std::size_t(pieces_of(samples.rows, size))), steps_(made_.size()) {}

const ShadowBounds *ShadowAreas::nearer_than(std::size_t area, float depth) const {
    std::call_once(made_[area], [&] { steps_[area] = steps_of(area); });
    const auto is_too_few = [&](const ShadowBounds &step) { return step.depth > depth; };
    const auto step = std::ranges::partition_point(steps_[area], is_too_few);
    return step == steps_[area].begin() ? nullptr : &*step;
}

// The first has none, the last one all.
std::vector<ShadowBounds> ShadowAreas::steps_of(std::size_t area) const {
    std::vector<std::uint32_t> nearest_first;
    const int left = int(area) % columns_ * size, top = int(area) / columns_ * size;
    for (int row = top; row < std::min(top + size, samples_.rows); ++row)
        for (int column = left; column < std::min(left + size, samples_.columns); ++column) {
            const SampleBlock &block = samples_.blocks[std::size_t(row * samples_.columns + column)];
            for (std::uint32_t i = block.begin; i < block.end; ++i) nearest_first.push_back(i);
        }
    std::ranges::sort(nearest_first, std::ranges::greater(),
                      [&](std::uint32_t i) { return samples_.depth[i]; });
    constexpr float none = std::numeric_limits<float>::infinity();
    ShadowBounds bounds{0, none, -none, none, -none, none, -none};
    const std::vector<float> &coc = samples_.hiding_coc();
    const std::size_t count = nearest_first.size(), in_step = pieces_of(count, most_steps);
    std::vector<ShadowBounds> steps;
    for (std::size_t n = 0; n <= count; ++n) {
        if (n == count || n % in_step == 0) {
            bounds.depth = n < count ? samples_.depth[nearest_first[n]] : -none;
            steps.push_back(bounds);
        }
        if (n == count) break;
        const std::uint32_t i = nearest_first[n];
        bounds.x_min = std::min(bounds.x_min, samples_.x[i]);
        bounds.x_max = std::max(bounds.x_max, samples_.x[i]);
        bounds.y_min = std::min(bounds.y_min, samples_.y[i]);
        bounds.y_max = std::max(bounds.y_max, samples_.y[i]);
        bounds.coc_min = std::min(bounds.coc_min, coc[i] - of_edges);
        bounds.coc_max = std::max(bounds.coc_max, coc[i] + of_edges);
    }
    return steps;
}

} // namespace sparselens
