#include "dof/lens/partial_samples.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sparselens {

namespace {

using lens_kernel::border;

// Sorts by depth, the nearest first, then by index.
std::uint64_t order_key(float depth, std::uint32_t sample) {
    return (std::uint64_t(~std::bit_cast<std::uint32_t>(depth)) << 32) | sample;
}

} // namespace

PartialSamples partial_samples_of(const BlockedSamples &samples, const TileTask &tile) {
    float reach_x = 0, reach_y = 0, beside = border; // per pixel of CoC; and besides
    for (const LensSample &p : tile.lens) {
        reach_x = std::max(reach_x, std::abs(p.x));
        reach_y = std::max(reach_y, std::abs(p.y));
        beside = std::max({beside, border + std::abs(p.pixel_x), border + std::abs(p.pixel_y)});
    }
    const auto in_reach = [&](std::uint32_t i) {
        const float coc = std::abs(samples.coc[i]), x = samples.x[i] - float(tile.origin.x),
                    y = samples.y[i] - float(tile.origin.y);
        const float across = coc * reach_x + beside, down = coc * reach_y + beside;
        return x > -across && x < float(tile.size) + across && y > -down && y < float(tile.size) + down;
    };
    std::vector<std::uint64_t> order;
    for (const std::uint32_t b : tile.samples)
        for (std::uint32_t i = samples.blocks[b].opaque_end; i < samples.blocks[b].end; ++i)
            if (in_reach(i)) order.push_back(order_key(samples.depth(i), i));
    std::sort(order.begin(), order.end());
    PartialSamples partial;
    partial.sample.assign(order.begin(), order.end()); // the lower half
    const auto in_order = [&](auto &to, const auto &value) {
        to.resize(order.size());
        std::ranges::transform(partial.sample, to.begin(), value);
    };
    in_order(partial.x, [&](std::uint32_t i) { return samples.x[i]; });
    in_order(partial.y, [&](std::uint32_t i) { return samples.y[i]; });
    in_order(partial.coc, [&](std::uint32_t i) { return samples.coc[i]; });
    in_order(partial.depth, [&](std::uint32_t i) { return samples.depth(i); });
    in_order(partial.left, [&](std::uint32_t i) { return 1 - samples.alpha[i]; });
    in_order(partial.key, [&](std::uint32_t i) { return samples.key(i); });
    return partial;
}

} // namespace sparselens
