#include "gpu/selective/selective_tiles.h"

#include "base/parallel.h"
#include "gpu/selective/splat_lists.h"

#include <algorithm>
#include <span>
#include <vector>

namespace sparselens::gpu {

namespace {

constexpr std::uint32_t code[] = {
#include <selective_tile.comp.inc>
};

constexpr std::uint32_t bindings = 14;
// Turns of its loops that a work group takes in a pass, and that all work groups submitted at once take. Operating
// systems end work that takes seconds.
constexpr double steps_in_pass = 2e5, steps_at_once = 2e6;

// Adds buffers with these arrays, in the order of the shader's bindings.
template <class... Arrays>
void upload(DeviceWorker &worker, std::vector<Buffer> &all, const Arrays &...arrays) {
    const auto add = [&](std::span<const std::byte> bytes) {
        all.push_back(worker.device.buffer(bytes.size()));
        worker.device.upload(all.back(), bytes);
        worker.report.uploaded += bytes.size();
    };
    (add(std::as_bytes(std::span(arrays))), ...);
}

void run(Device &device, const Program &program, const SplatScene &scene, const SplatArrays &from,
         const SplatLists &lists, std::span<const Buffer> all) {
    const auto tiles = std::uint32_t(lists.tiles.size());
    for (std::uint32_t pass = 0; pass < lists.passes; ++pass)
        for (std::uint32_t first = 0, end = 0; first < tiles; first = end) {
            for (double steps = 0; end < tiles && (end == first || steps < steps_at_once); ++end)
                steps += lists.steps[end];
            const splat_kernel::Push push{scene.pixel_aspect,
                                          scene.data.min.x,
                                          scene.data.min.y,
                                          scene.data.max.x,
                                          scene.data.max.y,
                                          first,
                                          tiles,
                                          pass,
                                          std::uint32_t(lists.passes),
                                          std::uint32_t(from.discs.size() / 3),
                                          std::uint32_t(scene.layers)};
            device.run(program, all, std::as_bytes(std::span(&push, 1)),
                       {end - first, std::uint32_t(from.groups), 1});
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
    if (!worker_.holds(largest_array(scene.splats), tasks.size())) return;
    if (!program_) program_.emplace(device.program("selective", code, bindings, sizeof(splat_kernel::Push)));
    const SplatArrays from = arrays_of(scene.splats);
    std::vector<Buffer> placed;
    upload(worker_, placed, from.discs, from.shares, from.colours, from.pieces, from.sums);
    const auto fit = [&](std::size_t begin, std::size_t most, std::size_t bytes) {
        return tasks_that_fit(scene, tasks.subspan(begin, most), bytes);
    };
    const auto work = [&](std::size_t begin, std::size_t count) -> const char * {
        const SplatLists lists = lists_of(scene, from, tasks.subspan(begin, count),
                                          std::min(steps_in_pass, device.most_turns() * 2 / 3));
        if (*std::ranges::max_element(lists.steps) > device.most_turns())
            return "more steps than the device takes";
        std::vector<Buffer> all = placed;
        upload(worker_, all, lists.pieces, lists.cuts, lists.tiles);
        const SplatState state = state_of(scene, count);
        const std::size_t pixels = count * splat_kernel::pixels;
        for (const std::size_t bytes :
             {state.layers * sizeof(double), state.gaps * sizeof(std::int32_t),
              state.states * sizeof(std::int32_t), lists.passes > 1 ? state.running * sizeof(double) : 0,
              from.groups * pixels * 4 * sizeof(float), pixels * sizeof(float)})
            all.push_back(device.buffer(bytes));
        run(device, *program_, scene, from, lists, all);
        std::vector<float> values(from.groups * pixels * 4), alphas(pixels);
        device.download(std::as_writable_bytes(std::span(values)), all[bindings - 2]);
        device.download(std::as_writable_bytes(std::span(alphas)), all[bindings - 1]);
        parallel_for(count, [&](std::size_t t) {
            done(begin + t,
                 {&values[t * splat_kernel::pixels * 4], &alphas[t * splat_kernel::pixels], pixels * 4});
        });
        return nullptr;
    };
    worker_.by_stripes(tasks.size(), 1, fit, work);
}

} // namespace sparselens::gpu
