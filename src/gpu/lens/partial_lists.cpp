#include "gpu/lens/partial_lists.h"

#include <algorithm>
#include <cmath>

namespace sparselens::gpu {

namespace {

constexpr float margin = 2; // pixels: those next to the quarter, and rounding
constexpr float size = lens_kernel::size;

// How far lens points move a sample: per pixel of CoC, and besides.
struct Reach {
    float x = 0, y = 0, all = 0;
};

Reach reach_of(const TileTask &task) {
    Reach reach;
    for (const LensSample &p : task.lens) {
        reach.x = std::max(reach.x, std::abs(p.x));
        reach.y = std::max(reach.y, std::abs(p.y));
        reach.all = std::max({reach.all, std::abs(p.pixel_x), std::abs(p.pixel_y)});
    }
    return reach;
}

bool within(float at, float first, float reach) { return at > first - reach && at < first + size + reach; }

} // namespace

PartialLists partial_lists(const BlockedSamples &samples, const TileTask &task) {
    const Reach reach = reach_of(task);
    std::vector<std::uint32_t> sorted;
    for (const std::uint32_t b : task.samples)
        for (std::uint32_t i = samples.blocks[b].opaque_end; i < samples.blocks[b].end; ++i)
            sorted.push_back(i);
    std::ranges::sort(sorted, [&](std::uint32_t a, std::uint32_t b) {
        return samples.depth(a) != samples.depth(b) ? samples.depth(a) > samples.depth(b) : a < b;
    });
    PartialLists lists;
    for (const std::uint32_t i : sorted) {
        const float coc = std::abs(samples.hiding_coc()[i]), beside = reach.all + margin,
                    across = coc * reach.x + beside, down = coc * reach.y + beside;
        for (std::size_t q = 0; q < lens_kernel::quarters; ++q) {
            const float left = float(task.origin.x) + float(q % 2) * size,
                        top = float(task.origin.y) + float(q / 2) * size;
            if (within(samples.x[i], left, across) && within(samples.y[i], top, down)) lists[q].push_back(i);
        }
    }
    return lists;
}

} // namespace sparselens::gpu
