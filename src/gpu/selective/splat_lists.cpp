#include "gpu/selective/splat_lists.h"

#include "base/grid.h"
#include "dof/selective/splats.h"

#include <algorithm>

namespace sparselens::gpu {

namespace {

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

} // namespace

SplatState state_of(const SplatScene &scene, std::size_t tiles) {
    const std::size_t places = tiles * groups_of(scene.splats),
                      entries = places * (scene.layers + 1) * splat_kernel::pixels;
    return {entries * splat_kernel::layer_sums, entries, places * 2 * splat_kernel::pixels,
            places * (splat_kernel::pixels + 1) * splat_kernel::bin_sums};
}

std::size_t groups_of(const SplatBlocks &splats) {
    return std::max<std::size_t>(1, pieces_of(splats.colours, std::size_t{4}));
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

} // namespace sparselens::gpu
