#include "gpu/selective/selective_tiles.h"

#include "base/grid.h"
#include "base/parallel.h"
#include "dof/selective/splats.h"
#include "kernels/layer_rules.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace sparselens::gpu {

// The lists of splats that tiles visit, in the layout that selective_tile.comp reads. The list of a tile is cut into
// passes. Each takes a limited number of steps, which are turns of the program's loops, because operating systems end
// work that takes seconds. A tile that is done sooner has empty passes at the end.
struct SplatLists {
    std::vector<std::uint32_t> pieces; // their numbers times 4, with the bits of the shader
    std::vector<std::uint32_t> cuts;   // [tile][pass]: where it begins in the pieces; one more is the end
    std::vector<splat_kernel::Tile> tiles;
    std::size_t passes = 0;
    double steps = 0; // of any tile in a pass, at most
};

namespace {

constexpr std::uint32_t code[] = {
#include <selective_tile.comp.inc>
};

constexpr std::uint32_t bindings = 13;
constexpr std::size_t tiles_at_once = 256; // limits the memory of their layers
constexpr double steps_in_pass = 5e4;      // of a tile

// Blocks of splats, cut into pieces.
struct SplatPieces {
    std::vector<splat_kernel::Piece> pieces;
    std::vector<std::uint32_t> first; // of each block; one more is the end
};

// The sizes, in numbers, of what stays on the device between passes.
struct SplatState {
    std::size_t layers, gaps, states, running;
};

constexpr std::size_t piece_size = 1024; // splats

// Upper bounds of the turns of the loops for a piece, and of those for the end of a bin.
double steps_of(const splat_kernel::Piece &piece) {
    constexpr double for_each_splat = 4 * 7, for_each_chunk = 32;
    const double splats = piece.end - piece.begin;
    return splats * for_each_splat + (splats / double(splat_kernel::chunk) + 1) * for_each_chunk + 1;
}
double steps_of_bin(const SplatScene &scene, std::size_t bins_before) {
    return double(splat_kernel::own) * (1 + (bins_before >= scene.layers ? 2 * double(scene.layers + 1) : 0));
}
double steps_of_blend(const SplatScene &scene) { return 4 * double(scene.layers + 2); }

// Lists what the tile visits; returns where its passes begin.
std::vector<std::uint32_t> list_tile(SplatLists &lists, const SplatScene &scene, const SplatPieces &pieces,
                                     const SplatTask &task, double most) {
    std::vector<std::uint32_t> begins{std::uint32_t(lists.pieces.size())};
    double steps = steps_of_blend(scene);
    std::size_t bins = 0;
    for (const VisitedBlock &visited : task.blocks) {
        const std::uint32_t first = pieces.first[visited.block], end = pieces.first[visited.block + 1],
                            last = visited.covers ? first : end - 1;
        for (std::uint32_t piece = first; piece <= last; ++piece) {
            const bool ends = visited.ends_bin && piece == last;
            const double takes = (visited.covers ? 1 : steps_of(pieces.pieces[piece])) +
                                 (ends ? steps_of_bin(scene, bins) : 0);
            if (steps + takes > most && begins.back() < lists.pieces.size()) {
                begins.push_back(std::uint32_t(lists.pieces.size()));
                steps = steps_of_blend(scene);
            }
            lists.pieces.push_back(piece << 2 | (visited.covers ? splat_kernel::covers : 0) |
                                   (ends ? splat_kernel::ends_bin : 0));
            steps += takes;
            lists.steps = std::max(lists.steps, steps);
            bins += ends;
        }
    }
    begins.push_back(std::uint32_t(lists.pieces.size()));
    return begins;
}

// Groups of four colours.
std::size_t groups_of(const SplatBlocks &splats) {
    return std::max<std::size_t>(1, pieces_of(splats.colours, std::size_t{4}));
}

SplatState state_of(const SplatScene &scene, std::size_t tiles) {
    const std::size_t places = tiles * groups_of(scene.splats),
                      entries = places * (scene.layers + 1) * splat_kernel::pixels;
    return {entries * splat_kernel::layer_sums, entries, places * 2 * splat_kernel::pixels,
            places * (splat_kernel::pixels + 1) * splat_kernel::bin_sums};
}

SplatPieces cut(const SplatBlocks &splats) {
    SplatPieces all;
    for (std::size_t b = 0; b < splats.blocks.size(); ++b) {
        const SplatBlock &block = splats.blocks[b];
        all.first.push_back(std::uint32_t(all.pieces.size()));
        for (std::size_t i = block.begin; i < block.end; i += piece_size)
            all.pieces.push_back({std::uint32_t(i), std::uint32_t(std::min(i + piece_size, block.end)),
                                  block.bin, std::uint32_t(b)});
    }
    all.first.push_back(std::uint32_t(all.pieces.size()));
    return all;
}

// `most_steps`: the largest number of steps of a tile in a pass. A single piece may take more.
SplatLists lists_of(const SplatScene &scene, const SplatPieces &pieces, std::span<const SplatTask> tasks,
                    double most_steps) {
    SplatLists lists;
    std::vector<std::vector<std::uint32_t>> begins;
    for (const SplatTask &task : tasks) {
        lists.tiles.push_back({task.tile.min.x, task.tile.min.y, task.tile.max.x, task.tile.max.y});
        begins.push_back(list_tile(lists, scene, pieces, task, most_steps));
        lists.passes = std::max(lists.passes, begins.back().size() - 1);
    }
    for (std::vector<std::uint32_t> &of : begins) {
        of.resize(lists.passes + 1, of.back());
        lists.cuts.insert(lists.cuts.end(), of.begin(), of.end());
    }
    return lists;
}

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
