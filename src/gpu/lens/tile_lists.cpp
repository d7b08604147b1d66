#include "gpu/lens/tile_lists.h"

#include "base/grid.h"
#include "base/parallel.h"
#include "deep/merge.h"
#include "dof/lens/tile_samples.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

namespace sparselens::gpu {

using namespace lens_kernel;

namespace {

constexpr int rows_a_word = 2;
constexpr std::size_t words_a_lens_point = tile_size / rows_a_word;

std::size_t partial_count(const BlockedSamples &samples, const TileTask &task) {
    std::size_t count = 0;
    for (const std::uint32_t b : task.samples) count += samples.blocks[b].end - samples.blocks[b].opaque_end;
    return count;
}

bool shares_lens(std::span<const TileTask> tasks, std::size_t t) {
    return t > 0 && tasks[t].lens.data() == tasks[t - 1].lens.data();
}

Imath::Box2i pixels_of(const GatherScene &scene, const TileTask &task) { // EXR coordinates
    const Imath::V2i first = scene.held_out.corner + task.origin;
    return {first, first + Imath::V2i(tile_size - 1)};
}

std::vector<std::uint32_t> columns_of(const GatherScene &scene, const TileTask &task) {
    const Imath::V2i first = pixels_of(scene, task).min;
    std::vector<std::uint32_t> words(scene.cat_eye() ? task.lens.size() * words_a_lens_point : 0);
    for (std::size_t word = 0; word < words.size(); ++word)
        for (int row = 0; row < rows_a_word; ++row) {
            const int y = int(word % words_a_lens_point) * rows_a_word + row;
            const auto [begin, end] = scene.cat_eye()->columns(task.lens[word / words_a_lens_point], first.x,
                                                               tile_size, first.y + y);
            words[word] |= std::uint32_t(begin | end << 8) << 16 * row;
        }
    return words;
}

std::vector<std::uint32_t> holdout_of(const GatherScene &scene, const TileTask &task) {
    std::vector<std::uint32_t> words;
    if (!scene.held_out.by) return words;
    const Imath::Box2i pixels = pixels_of(scene, task);
    const Imath::V2i first = pixels.min;
    std::vector<Holdout::Part> parts;
    parts.reserve(scene.held_out.by->parts_in(pixels));
    for (int y = 0; y < tile_size; ++y)
        for (int x = 0; x < tile_size; ++x) {
            words.push_back(std::uint32_t(parts.size()));
            scene.held_out.by->append_parts(first.x + x, first.y + y, parts);
        }
    words.push_back(std::uint32_t(parts.size()));
    for (const Holdout::Part &part : parts)
        for (const float value : {part.front, part.back, part.clear})
            words.push_back(std::bit_cast<std::uint32_t>(value));
    return words;
}

// Lists the samples of partial coverage that a tile's lens points can bring into each of its quarters: front to
// back, and in ascending order where depths are equal.
using PartialLists = std::array<std::vector<std::uint32_t>, quarters>;

PartialLists partial_of(const BlockedSamples &samples, const TileTask &task) {
    const LensReach reach(task.lens);
    PartialLists lists;
    for (const std::uint32_t i : partial_in_reach(samples, task))
        for (int q = 0; q < int(quarters); ++q)
            if (reach.brings(samples, i, task.origin + Imath::V2i(q % 2, q / 2) * size, size))
                lists[std::size_t(q)].push_back(i);
    return lists;
}

// Tables for the pixels of a tile.
struct LookedUp {
    std::vector<std::uint32_t> columns, holdout;
    PartialLists partial;
    TileNumbers numbers;
};

// Adds numbers to a list, and returns where they begin.
std::uint32_t append(std::vector<std::uint32_t> &list, std::span<const std::uint32_t> numbers,
                     std::size_t plus = 0) {
    const auto at = std::uint32_t(list.size());
    for (const std::uint32_t n : numbers) list.push_back(std::uint32_t(n + plus));
    return at;
}

std::uint32_t append(std::vector<Lens> &list, std::span<const LensSample> lens) {
    const auto at = std::uint32_t(list.size());
    for (const LensSample &p : lens)
        list.push_back({p.x, p.y, p.pixel_x, p.pixel_y, p.weight, p.rgb[0], p.rgb[1], p.rgb[2], p.behind[0],
                        p.behind[1], p.behind[2], p.in_front[0], p.in_front[1], p.in_front[2]});
    return at;
}

// Lists a tile, and the blocks that reach it.
Tile list_tile(TileLists &lists, const GatherScene &scene, const TileTask &task, const LookedUp &looked_up) {
    const std::size_t fillers = scene.samples.blocks.size(),
                      solids = fillers + scene.fillers.samples.blocks.size(),
                      facets = solids + scene.solids.blocks.size();
    const auto count = [](std::span<const std::uint32_t> list) { return std::uint32_t(list.size()); };
    Tile tile{};
    tile.x = float(task.origin.x);
    tile.y = float(task.origin.y);
    tile.size = task.size;
    tile.blocks = append(lists.blocks, task.samples);
    tile.block_count = count(task.samples);
    append(lists.blocks, task.fillers, fillers);
    tile.filler_count = count(task.fillers);
    for (std::size_t q = 0; q < quarters; ++q) {
        tile.partial[q] = append(lists.partial, looked_up.partial[q]);
        tile.partial_count[q] = count(looked_up.partial[q]);
    }
    tile.lens_count = std::uint32_t(task.lens.size());
    tile.facets = append(lists.blocks, task.facets, facets);
    tile.facet_count = count(task.facets);
    tile.solids = append(lists.blocks, task.solids, solids);
    tile.solid_count = count(task.solids);
    tile.columns = append(lists.columns, looked_up.columns);
    tile.holdout = append(lists.holdout, looked_up.holdout);
    tile.runs = count(lists.blocks);
    tile.run_count = std::uint32_t(looked_up.numbers.runs.size());
    for (const NumberRun &run : looked_up.numbers.runs)
        lists.blocks.insert(lists.blocks.end(), {run.begin, run.number});
    lists.blocks.insert(lists.blocks.end(), {0, 0}); // one is always read
    tile.numbers = count(lists.blocks);
    lists.blocks.resize(tile.numbers + looked_up.numbers.count());
    for (const NumberRun &run : looked_up.numbers.runs)
        for (std::uint32_t i = run.begin; i < run.end; ++i)
            lists.blocks[tile.numbers + run.number - (i - run.begin)] = i;
    tile.number_bits = std::uint32_t(looked_up.numbers.bits);
    tile.units = looked_up.numbers.units;
    return tile;
}

} // namespace

double turns_of(const GatherScene &scene, const TileTask &task) {
    const auto turns = [](const auto &blocks, std::span<const std::uint32_t> of) {
        double sum = 0;
        for (const std::uint32_t b : of) sum += 2 + double(blocks[b].end - blocks[b].begin) / 32;
        return sum;
    };
    return 800 + turns(scene.samples.blocks, task.samples) +
           turns(scene.fillers.samples.blocks, task.fillers) + 3 * turns(scene.solids.blocks, task.solids) +
           12 * turns(scene.facets.blocks, task.facets) + double(partial_count(scene.samples, task));
}

TileLists lists_of(const GatherScene &scene, std::span<const TileTask> tasks, std::uint32_t points,
                   double most_turns) {
    constexpr double turns_at_once = 6e7, most_of_tile = 1e6; // of all tiles, and of each
    std::vector<LookedUp> looked_up(tasks.size());
    std::vector<double> turns(tasks.size());
    parallel_for(tasks.size(), [&](std::size_t t) {
        turns[t] = turns_of(scene, tasks[t]);
        looked_up[t] = {columns_of(scene, tasks[t]), holdout_of(scene, tasks[t]),
                        partial_of(scene.samples, tasks[t]), number_tile(scene, tasks[t])};
    });
    const double groups = turns_at_once / (points * std::accumulate(turns.begin(), turns.end(), 0.0));
    TileLists lists;
    std::uint32_t lens = 0;
    float weight = 0;
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        Tile &tile = lists.tiles.emplace_back(list_tile(lists, scene, tasks[t], looked_up[t]));
        looked_up[t] = {};
        if (!shares_lens(tasks, t)) {
            lens = append(lists.lens, tasks[t].lens);
            weight = 0;
            for (const LensSample &p : tasks[t].lens) weight += p.weight;
        }
        tile.lens = lens;
        tile.weight = weight;
        const double in_pass =
            std::clamp(std::min(std::min(most_turns, most_of_tile) / turns[t], groups), 1.0, 1e6);
        tile.lens_in_pass = points * std::uint32_t(in_pass);
        lists.passes = std::max(lists.passes, pieces_of(tile.lens_count, tile.lens_in_pass));
    }
    return lists;
}

std::uint32_t rules_of(const GatherScene &scene, std::span<const TileTask> tasks) {
    std::uint32_t rules = 0;
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        if (!shares_lens(tasks, t))
            for (const LensSample &p : tasks[t].lens) {
                if (p.rgb != no_factors) rules |= weighted;
                if (p.behind != no_factors || p.in_front != no_factors) rules |= weighted | two_sided;
            }
        for (const std::uint32_t b : tasks[t].samples) {
            const SampleBlock &block = scene.samples.blocks[b];
            if (block.shows_images) rules |= images;
            if (block.opaque_end != block.end) rules |= with_partial;
        }
        if (!tasks[t].facets.empty()) rules |= with_facets;
        if (!tasks[t].solids.empty()) rules |= with_solids;
    }
    if (scene.cat_eye()) rules |= weighted | cat_eye;
    if (scene.cat_eye() && scene.cat_eye()->darkens()) rules |= darkens;
    if (scene.held_out.by) rules |= holdout;
    return rules;
}

} // namespace sparselens::gpu
