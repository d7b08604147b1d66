#include "gpu/selective/selective_tiles.h"

#include "base/parallel.h"
#include "gpu/selective/splat_stripe.h"

#include <algorithm>
#include <span>
#include <vector>

namespace sparselens::gpu {

namespace {

constexpr std::uint32_t code[] = {
#include <selective_tile.comp.inc>
};

constexpr std::uint32_t buffers = 14;
// Turns of its loops that a work group takes in a pass, and that all work groups submitted at once take. Operating
// systems end work that takes seconds.
constexpr double steps_in_pass = 2e5, steps_at_once = 2e6;

// Returns the buffers of a stripe in the order of the shader's bindings. The last two are the picture.
std::vector<Buffer> place(Device &device, const SplatScene &scene, const SplatStripe &stripe,
                          std::size_t &uploaded) {
    std::vector<Buffer> all;
    const auto upload = [&](const auto &values) {
        const auto bytes = std::as_bytes(std::span(values));
        all.push_back(device.buffer(bytes.size()));
        device.upload(all.back(), bytes);
        uploaded += bytes.size();
    };
    upload(stripe.discs);
    upload(stripe.shares);
    upload(stripe.colours);
    upload(stripe.pieces);
    upload(stripe.sums);
    upload(stripe.lists);
    upload(stripe.cuts);
    upload(stripe.tiles);
    const std::size_t tiles = stripe.tiles.size(), pixels = tiles * splat_kernel::pixels;
    const SplatState state = state_of(scene, tiles);
    for (const std::size_t bytes :
         {state.layers * sizeof(double), state.gaps * sizeof(std::int32_t),
          state.states * sizeof(std::int32_t), stripe.passes > 1 ? state.running * sizeof(double) : 0,
          stripe.groups * pixels * 4 * sizeof(float), pixels * sizeof(float)})
        all.push_back(device.buffer(bytes));
    return all;
}

void run(Device &device, const Program &program, const SplatScene &scene, const SplatStripe &stripe,
         std::span<const Buffer> all) {
    const auto tiles = std::uint32_t(stripe.tiles.size());
    for (std::uint32_t pass = 0; pass < stripe.passes; ++pass)
        for (std::uint32_t first = 0, end = 0; first < tiles; first = end) {
            for (double steps = 0; end < tiles && (end == first || steps < steps_at_once); ++end)
                steps += stripe.steps[end];
            const splat_kernel::Push push{scene.pixel_aspect,
                                          scene.data.min.x,
                                          scene.data.min.y,
                                          scene.data.max.x,
                                          scene.data.max.y,
                                          first,
                                          tiles,
                                          pass,
                                          std::uint32_t(stripe.passes),
                                          std::uint32_t(stripe.splats),
                                          std::uint32_t(scene.layers)};
            device.run(program, all, std::as_bytes(std::span(&push, 1)),
                       {end - first, std::uint32_t(stripe.groups), 1});
        }
}

} // namespace

void SelectiveTilesOnDevice::gather(const SplatScene &scene, std::span<const SplatTask> tasks,
                                    const std::function<void(std::size_t, const SplatPicture &)> &done) {
    Device &device = worker_.device;
    if (!device.info().float64) {
        worker_.report.on_cpu["the device has no numbers of 64 bits"] += tasks.size();
        return;
    }
    if (!program_) program_.emplace(device.program("selective", code, buffers, sizeof(splat_kernel::Push)));
    const auto fit = [&](std::size_t begin, std::size_t most, std::size_t bytes) {
        return tasks_that_fit(scene, tasks.subspan(begin, most), bytes);
    };
    const auto work = [&](std::size_t begin, std::size_t count) -> const char * {
        const SplatStripe stripe = make_stripe(scene, tasks.subspan(begin, count),
                                               std::min(steps_in_pass, device.most_turns() * 2 / 3));
        if (*std::ranges::max_element(stripe.steps) > device.most_turns())
            return "more steps than the device takes";
        const std::vector<Buffer> placed = place(device, scene, stripe, worker_.report.uploaded);
        run(device, *program_, scene, stripe, placed);
        std::vector<float> values(stripe.groups * count * splat_kernel::pixels * 4),
            alphas(count * splat_kernel::pixels);
        device.download(std::as_writable_bytes(std::span(values)), placed[buffers - 2]);
        device.download(std::as_writable_bytes(std::span(alphas)), placed[buffers - 1]);
        parallel_for(count, [&](std::size_t t) {
            done(begin + t, {&values[t * splat_kernel::pixels * 4], &alphas[t * splat_kernel::pixels],
                             count * splat_kernel::pixels * 4});
        });
        return nullptr;
    };
    worker_.by_stripes(tasks.size(), 1, fit, work);
}

} // namespace sparselens::gpu
