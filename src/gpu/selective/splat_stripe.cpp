#include "gpu/selective/splat_stripe.h"

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

// The splats of blocks that tiles visit.
struct Range {
    std::size_t begin = ~std::size_t{0}, end = 0;

    void add(const SplatBlocks &splats, const SplatTask &task) {
        for (const VisitedBlock &visited : task.blocks) {
            begin = std::min(begin, splats.blocks[visited.block].begin);
            end = std::max(end, splats.blocks[visited.block].end);
        }
    }
    std::size_t count() const { return begin < end ? end - begin : 0; }
    bool holds(const SplatBlock &block) const { return block.begin >= begin && block.end <= end; }
};

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

void place_splats(SplatStripe &stripe, const SplatBlocks &from, const Range &range) {
    stripe.discs.resize(stripe.splats * 3);
    stripe.shares.resize(stripe.splats * 3);
    stripe.colours.resize(stripe.groups * stripe.splats * 4);
    parallel_ranges(stripe.splats, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t to = begin; to < end; ++to) {
            const std::size_t i = range.begin + to;
            const std::span<const float> value = from.value(i);
            std::ranges::copy(std::array{from.x[i], from.y[i], from.radius[i]}, &stripe.discs[3 * to]);
            std::ranges::copy(std::array{value[0], value[1], value.back()}, &stripe.shares[3 * to]);
            for (std::size_t k = 0; k < from.colours; ++k)
                stripe.colours[(k / 4 * stripe.splats + to) * 4 + k % 4] = value[sums_before_colours + k];
        }
    });
}

void place_sums(SplatStripe &stripe, const SplatBlocks &from) {
    stripe.sums.resize(from.blocks.size() * stripe.groups * splat_kernel::bin_sums);
    for (std::size_t b = 0; b < from.blocks.size(); ++b) {
        const double *sums = &from.sums[b * from.size()];
        for (std::size_t g = 0; g < stripe.groups; ++g) {
            double *to = &stripe.sums[(b * stripe.groups + g) * splat_kernel::bin_sums];
            std::copy_n(sums, sums_before_colours, to);
            for (std::size_t k = 4 * g; k < std::min(4 * g + 4, from.colours); ++k)
                to[sums_before_colours + k % 4] = sums[sums_before_colours + k];
            to[splat_kernel::bin_sums - 1] = sums[from.size() - 1];
        }
    }
}

// Returns the first piece of each block; one more entry is the end. Pieces of blocks outside the range are never used.
std::vector<std::uint32_t> place_pieces(SplatStripe &stripe, const SplatBlocks &from, const Range &range) {
    std::vector<std::uint32_t> first{0};
    for (std::size_t b = 0; b < from.blocks.size(); ++b) {
        const SplatBlock &block = from.blocks[b];
        for (std::size_t i = block.begin; range.holds(block) && i < block.end; i += piece_size)
            stripe.pieces.push_back({std::uint32_t(i - range.begin),
                                     std::uint32_t(std::min(i + piece_size, block.end) - range.begin),
                                     block.bin, std::uint32_t(b)});
        first.push_back(std::uint32_t(stripe.pieces.size()));
    }
    return first;
}

// Lists what the tile visits; returns where its passes begin.
std::vector<std::uint32_t> list_tile(SplatStripe &stripe, const SplatScene &scene, const SplatTask &task,
                                     std::span<const std::uint32_t> first_piece, double most) {
    std::vector<std::uint32_t> begins{std::uint32_t(stripe.lists.size())};
    double steps = steps_of_blend(scene), largest = steps;
    std::size_t bins = 0;
    for (const VisitedBlock &visited : task.blocks) {
        const std::uint32_t first = first_piece[visited.block], end = first_piece[visited.block + 1],
                            last = visited.covers ? first : end - 1;
        for (std::uint32_t piece = first; piece <= last; ++piece) {
            const bool ends = visited.ends_bin && piece == last;
            const double takes = (visited.covers ? 1 : steps_of(stripe.pieces[piece])) +
                                 (ends ? steps_of_bin(scene, bins) : 0);
            if (steps + takes > most && begins.back() < stripe.lists.size()) {
                begins.push_back(std::uint32_t(stripe.lists.size()));
                steps = steps_of_blend(scene);
            }
            stripe.lists.push_back(piece << 2 | (visited.covers ? splat_kernel::covers : 0) |
                                   (ends ? splat_kernel::ends_bin : 0));
            steps += takes;
            largest = std::max(largest, steps);
            bins += ends;
        }
    }
    begins.push_back(std::uint32_t(stripe.lists.size()));
    stripe.steps.push_back(largest);
    return begins;
}

} // namespace

SplatState state_of(const SplatScene &scene, std::size_t tiles) {
    const std::size_t places = tiles * groups_of(scene.splats),
                      entries = places * (scene.layers + 1) * splat_kernel::pixels;
    return {entries * splat_kernel::layer_sums, entries, places * 2 * splat_kernel::pixels,
            places * (splat_kernel::pixels + 1) * splat_kernel::bin_sums};
}

std::size_t tasks_that_fit(const SplatScene &scene, std::span<const SplatTask> tasks, std::size_t bytes) {
    const std::size_t groups = groups_of(scene.splats);
    if (scene.splats.blocks.size() * groups * splat_kernel::bin_sums * sizeof(double) > bytes) return 0;
    Range range;
    std::size_t listed = 0;
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        range.add(scene.splats, tasks[t]);
        for (const VisitedBlock &visited : tasks[t].blocks)
            listed += pieces_of_block(scene.splats.blocks[visited.block]);
        const SplatState state = state_of(scene, t + 1);
        const std::size_t most =
            std::max({range.count() * 3 * sizeof(double), range.count() * groups * 16, listed * 4,
                      state.layers * sizeof(double), state.running * sizeof(double)});
        if (most > bytes) return t;
    }
    return tasks.size();
}

SplatStripe make_stripe(const SplatScene &scene, std::span<const SplatTask> tasks, double steps) {
    SplatStripe stripe;
    Range range;
    for (const SplatTask &task : tasks) range.add(scene.splats, task);
    stripe.groups = groups_of(scene.splats);
    stripe.splats = range.count();
    place_splats(stripe, scene.splats, range);
    place_sums(stripe, scene.splats);
    const std::vector<std::uint32_t> first_piece = place_pieces(stripe, scene.splats, range);
    std::vector<std::vector<std::uint32_t>> begins;
    for (const SplatTask &task : tasks) {
        stripe.tiles.push_back({task.tile.min.x, task.tile.min.y, task.tile.max.x, task.tile.max.y});
        begins.push_back(list_tile(stripe, scene, task, first_piece, steps));
        stripe.passes = std::max(stripe.passes, begins.back().size() - 1);
    }
    for (std::vector<std::uint32_t> &of : begins) {
        of.resize(stripe.passes + 1, of.back());
        stripe.cuts.insert(stripe.cuts.end(), of.begin(), of.end());
    }
    return stripe;
}

} // namespace sparselens::gpu
