#include "gpu/selective/selective_tiles.h"

#include "base/parallel.h"
#include "dof/selective/splats.h"
#include "gpu/selective/splat_lists.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace sparselens::gpu {

namespace {

constexpr std::uint32_t code[] = {
#include <selective_tile.comp.inc>
};

constexpr std::uint32_t bindings = 13;
constexpr std::size_t tiles_at_once = 256; // limits the memory of their layers
constexpr double steps_in_pass = 5e4;      // of a tile

using Bytes = std::span<const std::byte>;

// The bytes of some arrays, which follow one another in a buffer.
std::vector<Bytes> joined_bytes(const auto &...arrays) { return {std::as_bytes(std::span(arrays))...}; }

// Uploads to buffers, in the order of the shader's bindings.
void upload(DeviceWorker &worker, std::vector<Buffer> &to, std::span<const std::vector<Bytes>> parts) {
    std::vector<std::size_t> sizes(parts.size());
    for (std::size_t n = 0; n < parts.size(); ++n)
        for (const Bytes &array : parts[n]) sizes[n] += array.size();
    worker.device.make_room(to, sizes);
    for (std::size_t n = 0; n < parts.size(); ++n) {
        std::size_t at = 0;
        for (const Bytes &array : parts[n]) {
            worker.device.upload(to[n], array, at);
            at += array.size();
        }
        worker.report.uploaded += at;
    }
}

} // namespace

const Program &SelectiveTilesOnDevice::program_for(std::size_t colours) {
    const std::array constants{std::uint32_t(colours)};
    if (!programs_.contains(colours))
        programs_.emplace(colours, worker_.device.program("selective", code, bindings,
                                                          sizeof(splat_kernel::Push), constants));
    return programs_.at(colours);
}

void SelectiveTilesOnDevice::gather(const SplatScene &scene, std::span<const SplatTask> tasks,
                                    const std::function<void(std::size_t, const SplatPicture &)> &done) {
    const double most_steps = worker_.device.most_turns();
    if (!worker_.device.info().float64) {
        worker_.report.on_cpu["the device has no numbers of 64 bits"] += tasks.size();
        return;
    }
    const SplatBlocks &splats = scene.splats;
    const SplatPieces pieces = cut(splats);
    upload(worker_, splats_,
           std::array{joined_bytes(splats.x, splats.y, splats.radius), joined_bytes(splats.values),
                      joined_bytes(pieces.pieces), joined_bytes(splats.sums)});
    const auto work = [&](std::size_t begin, std::size_t count) -> const char * {
        const SplatLists lists =
            lists_of(scene, pieces, tasks.subspan(begin, count), std::min(steps_in_pass, most_steps * 2 / 3));
        if (lists.steps > most_steps) return "more steps than the device takes";
        upload(worker_, lists_,
               std::array{joined_bytes(lists.pieces), joined_bytes(lists.cuts), joined_bytes(lists.tiles)});
        gather_stripe(scene, lists,
                      [&](std::size_t t, const SplatPicture &picture) { done(begin + t, picture); });
        return nullptr;
    };
    worker_.by_stripes(tasks.size(), tiles_at_once, work);
}

void SelectiveTilesOnDevice::gather_stripe(
    const SplatScene &scene, const SplatLists &lists,
    const std::function<void(std::size_t, const SplatPicture &)> &done) {
    const std::size_t count = lists.tiles.size(), groups = groups_of(scene.splats),
                      pixels = count * splat_kernel::pixels;
    const SplatState state = state_of(scene, count);
    Device &device = worker_.device;
    device.make_room(made_, std::array{state.layers * sizeof(double), state.gaps * sizeof(std::int32_t),
                                       state.states * sizeof(std::int32_t),
                                       lists.passes > 1 ? state.running * sizeof(double) : 0,
                                       groups * pixels * 4 * sizeof(float), pixels * sizeof(float)});
    std::vector<Buffer> all;
    for (const auto *some : {&splats_, &lists_, &made_}) all.insert(all.end(), some->begin(), some->end());
    const Imath::Box2i &data = scene.data;
    for (std::uint32_t pass = 0; pass < lists.passes; ++pass) {
        if (pass > 0) device.finish();
        const splat_kernel::Push push{scene.pixel_aspect,
                                      data.min.x,
                                      data.min.y,
                                      data.max.x,
                                      data.max.y,
                                      std::uint32_t(count),
                                      pass,
                                      std::uint32_t(lists.passes),
                                      std::uint32_t(scene.splats.x.size()),
                                      std::uint32_t(scene.layers),
                                      0};
        device.run(program_for(scene.splats.colours), all, std::as_bytes(std::span(&push, 1)),
                   {push.tile_count, std::uint32_t(groups), 1});
    }
    std::vector<float> values(groups * pixels * 4), alphas(pixels);
    device.finish(std::array{Download{std::as_writable_bytes(std::span(values)), all[bindings - 2]},
                             Download{std::as_writable_bytes(std::span(alphas)), all[bindings - 1]}});
    parallel_for(count, [&](std::size_t t) {
        done(t, {&values[t * splat_kernel::pixels * 4], &alphas[t * splat_kernel::pixels], pixels * 4});
    });
}

} // namespace sparselens::gpu
