#include "gpu/lens/lens_tiles.h"

#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace sparselens::gpu {

namespace {

constexpr std::uint32_t code[] = {
#include <lens_tile.comp.inc>
};

constexpr std::size_t stripe_bytes = std::size_t{512} << 20; // of a buffer, also where a device allows more
constexpr std::uint32_t quarters = 4;                        // work groups a tile
// Tests of a sample by a lens point that are submitted at once: what takes seconds, operating systems end.
constexpr double work_at_once = 2e9;

struct Push {
    std::uint32_t first_tile, tile_count, sample_count, first_filler;
    float depth_at_1;
};

// Mesa's device in software ends a program after 65535 turns of its loops, and what it has not written is garbage. About so
// many turns a tile takes; more than it may, rather than less.
bool takes_long_in_software(const TileScene &scene, const TileTask &task) {
    std::size_t partial = 0;
    for (const std::uint32_t b : task.samples)
        partial += scene.samples.blocks[b].end - scene.samples.blocks[b].opaque_end;
    const std::size_t blocks = task.samples.size() + task.fillers.size() + 4 * task.facets.size();
    return task.lens.size() * (100 + blocks + partial / 4) > 60'000;
}

double work_of(const Stripe &stripe, const StripeTile &tile) {
    double samples = quarters * double(tile.partial_count);
    for (std::uint32_t n = 0; n < tile.block_count; ++n) {
        const StripeBlock &block = stripe.blocks[stripe.block_lists[tile.blocks + n]];
        samples += block.opaque_end - block.begin;
    }
    return samples * tile.lens_count;
}

} // namespace

void LensTilesOnDevice::gather(const TileScene &scene, std::span<const TileTask> tasks,
                               const std::function<void(std::size_t, const TilePicture &)> &done,
                               TileReport &report) {
    const auto lasts = [&](const TileTask &task) { return takes_long_in_software(scene, task); };
    if (device_.info().kind == Kind::software && std::ranges::any_of(tasks, lasts)) {
        report.on_cpu["more steps than a device in software takes"] += tasks.size();
        return;
    }
    if (!program_) program_.emplace(device_.program(code, 17, sizeof(Push)));
    const std::size_t bytes = std::min(stripe_bytes, device_.largest_buffer());
    for (std::size_t begin = 0, count = 0; begin < tasks.size(); begin += std::max(count, std::size_t{1})) {
        count = tasks_that_fit(scene, tasks.subspan(begin), bytes);
        if (count == 0) ++report.on_cpu["more samples than its buffers hold"];
        if (count == 0) continue;
        const bool whole = count == tasks.size() && fits_whole(scene, tasks, bytes);
        if (!whole) buffers_ = {};
        report.uploaded += buffers_.bring(device_, make_stripe(scene, tasks.subspan(begin, count), whole));
        gather_stripe(scene, [&](std::size_t t, const TilePicture &picture) { done(begin + t, picture); });
        if (!whole) buffers_ = {};
        report.on_device += count;
    }
}

void LensTilesOnDevice::gather_stripe(const TileScene &scene,
                                      const std::function<void(std::size_t, const TilePicture &)> &done) {
    const std::size_t tiles = buffers_.stripe().tiles.size(), groups = scene.colours.groups,
                      all = tiles * tile_pixels * groups;
    const Buffer values = device_.buffer(all * 4 * sizeof(float)),
                 known = device_.buffer(all * sizeof(float));
    run(buffers_.stripe(), groups, float(scene.depth_at_1), buffers_.bindings(values, known));
    std::vector<float> value(all * 4), knowns(all);
    device_.download(std::as_writable_bytes(std::span(value)), values);
    device_.download(std::as_writable_bytes(std::span(knowns)), known);
    parallel_for(tiles, [&](std::size_t t) {
        done(t, {&value[t * tile_pixels * 4], &knowns[t * tile_pixels], groups, tiles * tile_pixels * 4});
    });
}

void LensTilesOnDevice::run(const Stripe &stripe, std::size_t groups, float depth_at_1,
                            std::span<const Buffer *const> buffers) {
    const auto tiles = std::uint32_t(stripe.tiles.size());
    for (std::uint32_t first = 0, end = 0; first < tiles; first = end) {
        for (double work = 0; end < tiles && (end == first || work < work_at_once); ++end)
            work += work_of(stripe, stripe.tiles[end]);
        const Push push{first, tiles, std::uint32_t(stripe.places.size()), std::uint32_t(stripe.first_filler),
                        depth_at_1};
        device_.run(*program_, buffers, std::as_bytes(std::span(&push, 1)),
                    {quarters * (end - first), std::uint32_t(groups), 1});
    }
}

} // namespace sparselens::gpu
