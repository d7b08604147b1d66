#include "gpu/selective/splat_lists.h"

#include "base/grid.h"
#include "base/parallel.h"
#include "dof/selective/splats.h"

#include <algorithm>

namespace sparselens::gpu {

namespace {

constexpr std::size_t piece_size = 1024; // splats

std::size_t groups_of(const SplatBlocks &splats) {
    return std::max<std::size_t>(1, pieces_of(splats.colours, std::size_t{4}));
}

std::size_t pieces_of_block(const SplatBlock &block) {
    return pieces_of(block.end - block.begin, piece_size);
}

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

void place_splats(SplatArrays &arrays, const SplatBlocks &from) {
    const std::size_t count = from.x.size();
    arrays.discs.resize(count * 3);
    arrays.shares.resize(count * 3);
    arrays.colours.resize(arrays.groups * count * 4);
    parallel_ranges(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::span<const float> value = from.value(i);
            std::ranges::copy(std::array{from.x[i], from.y[i], from.radius[i]}, &arrays.discs[3 * i]);
            std::ranges::copy(std::array{value[0], value[1], value.back()}, &arrays.shares[3 * i]);
            for (std::size_t k = 0; k < from.colours; ++k)
                arrays.colours[(k / 4 * count + i) * 4 + k % 4] = value[sums_before_colours + k];
        }
    });
}

void place_sums(SplatArrays &arrays, const SplatBlocks &from) {
    arrays.sums.resize(from.blocks.size() * arrays.groups * splat_kernel::bin_sums);
    for (std::size_t b = 0; b < from.blocks.size(); ++b) {
        const double *sums = &from.sums[b * from.size()];
        for (std::size_t g = 0; g < arrays.groups; ++g) {
            double *to = &arrays.sums[(b * arrays.groups + g) * splat_kernel::bin_sums];
            std::copy_n(sums, sums_before_colours, to);
            for (std::size_t k = 4 * g; k < std::min(4 * g + 4, from.colours); ++k)
                to[sums_before_colours + k % 4] = sums[sums_before_colours + k];
            to[splat_kernel::bin_sums - 1] = sums[from.size() - 1];
        }
    }
}

void place_pieces(SplatArrays &arrays, const SplatBlocks &from) {
    for (std::size_t b = 0; b < from.blocks.size(); ++b) {
        const SplatBlock &block = from.blocks[b];
        arrays.first_piece.push_back(std::uint32_t(arrays.pieces.size()));
        for (std::size_t i = block.begin; i < block.end; i += piece_size)
            arrays.pieces.push_back({std::uint32_t(i), std::uint32_t(std::min(i + piece_size, block.end)),
                                     block.bin, std::uint32_t(b)});
    }
    arrays.first_piece.push_back(std::uint32_t(arrays.pieces.size()));
}

// Lists what the tile visits; returns where its passes begin.
std::vector<std::uint32_t> list_tile(SplatLists &lists, const SplatScene &scene, const SplatArrays &arrays,
                                     const SplatTask &task, double most) {
    std::vector<std::uint32_t> begins{std::uint32_t(lists.pieces.size())};
    double steps = steps_of_blend(scene), largest = steps;
    std::size_t bins = 0;
    for (const VisitedBlock &visited : task.blocks) {
        const std::uint32_t first = arrays.first_piece[visited.block],
                            end = arrays.first_piece[visited.block + 1],
                            last = visited.covers ? first : end - 1;
        for (std::uint32_t piece = first; piece <= last; ++piece) {
            const bool ends = visited.ends_bin && piece == last;
            const double takes = (visited.covers ? 1 : steps_of(arrays.pieces[piece])) +
                                 (ends ? steps_of_bin(scene, bins) : 0);
            if (steps + takes > most && begins.back() < lists.pieces.size()) {
                begins.push_back(std::uint32_t(lists.pieces.size()));
                steps = steps_of_blend(scene);
            }
            lists.pieces.push_back(piece << 2 | (visited.covers ? splat_kernel::covers : 0) |
                                   (ends ? splat_kernel::ends_bin : 0));
            steps += takes;
            largest = std::max(largest, steps);
            bins += ends;
        }
    }
    begins.push_back(std::uint32_t(lists.pieces.size()));
    lists.steps.push_back(largest);
    return begins;
}

} // namespace

SplatState state_of(const SplatScene &scene, std::size_t tiles) {
    const std::size_t places = tiles * groups_of(scene.splats),
                      entries = places * (scene.layers + 1) * splat_kernel::pixels;
    return {entries * splat_kernel::layer_sums, entries, places * 2 * splat_kernel::pixels,
            places * (splat_kernel::pixels + 1) * splat_kernel::bin_sums};
}

std::size_t largest_array(const SplatBlocks &splats) {
    const std::size_t groups = groups_of(splats);
    return std::max({splats.x.size() * 3 * sizeof(double), splats.x.size() * groups * 4 * sizeof(float),
                     splats.blocks.size() * groups * splat_kernel::bin_sums * sizeof(double)});
}

SplatArrays arrays_of(const SplatBlocks &splats) {
    SplatArrays arrays;
    arrays.groups = groups_of(splats);
    place_splats(arrays, splats);
    place_sums(arrays, splats);
    place_pieces(arrays, splats);
    return arrays;
}

std::size_t tasks_that_fit(const SplatScene &scene, std::span<const SplatTask> tasks, std::size_t bytes) {
    std::size_t listed = 0;
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        for (const VisitedBlock &visited : tasks[t].blocks)
            listed += pieces_of_block(scene.splats.blocks[visited.block]);
        const SplatState state = state_of(scene, t + 1);
        if (std::max({listed * 4, state.layers * sizeof(double), state.running * sizeof(double)}) > bytes)
            return t;
    }
    return tasks.size();
}

SplatLists lists_of(const SplatScene &scene, const SplatArrays &arrays, std::span<const SplatTask> tasks,
                    double steps) {
    SplatLists lists;
    std::vector<std::vector<std::uint32_t>> begins;
    for (const SplatTask &task : tasks) {
        lists.tiles.push_back({task.tile.min.x, task.tile.min.y, task.tile.max.x, task.tile.max.y});
        begins.push_back(list_tile(lists, scene, arrays, task, steps));
        lists.passes = std::max(lists.passes, begins.back().size() - 1);
    }
    for (std::vector<std::uint32_t> &of : begins) {
        of.resize(lists.passes + 1, of.back());
        lists.cuts.insert(lists.cuts.end(), of.begin(), of.end());
    }
    return lists;
}

} // namespace sparselens::gpu
