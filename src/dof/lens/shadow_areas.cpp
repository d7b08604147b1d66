#include "dof/lens/shadow_areas.h"

#include "base/grid.h"

#include <algorithm>
#include <utility>

namespace sparselens {

namespace {

constexpr std::size_t most_steps = 16;
constexpr float of_edges =
    0.5f; // pixels: by how much the CoC of an edge differs from that of its sample, at most

} // namespace

ShadowAreas::ShadowAreas(const BlockedSamples &samples)
    : samples_(samples), columns_(pieces_of(samples.columns, size)),
      made_(std::size_t(columns_) * std::size_t(pieces_of(samples.rows, size))), steps_(made_.size()) {}

const NearBounds *ShadowAreas::nearer_than(std::size_t area, float depth) const {
    std::call_once(made_[area], [&] { steps_[area] = steps_of(area); });
    return steps_[area].nearer_than(depth);
}

NearSteps ShadowAreas::steps_of(std::size_t area) const {
    std::vector<NearBounds> samples;
    const std::vector<float> &coc = samples_.hiding_coc();
    const int left = int(area) % columns_ * size, top = int(area) / columns_ * size;
    for (int row = top; row < std::min(top + size, samples_.rows); ++row)
        for (int column = left; column < std::min(left + size, samples_.columns); ++column) {
            const SampleBlock &block = samples_.blocks[std::size_t(row * samples_.columns + column)];
            for (std::uint32_t i = block.begin; i < block.end; ++i)
                samples.push_back({samples_.depth[i], samples_.x[i], samples_.x[i], samples_.y[i],
                                   samples_.y[i], coc[i] - of_edges, coc[i] + of_edges});
        }
    const std::size_t in_step = std::max(pieces_of(samples.size(), most_steps), std::size_t(1));
    return {std::move(samples), in_step};
}

} // namespace sparselens
