#include "gpu/lens/stripe.h"

#include "base/parallel.h"
#include "gpu/lens/stripe_ranges.h"
#include "gpu/lens/tile_rules.h"

#include <algorithm>
#include <bit>

namespace sparselens::gpu {

namespace {

std::size_t partial_count(const BlockedSamples &samples, const TileTask &task) {
    std::size_t count = 0;
    for (const std::uint32_t b : task.samples) count += samples.blocks[b].end - samples.blocks[b].opaque_end;
    return count;
}

// A range, and where its samples and blocks are in the stripe.
struct Placed {
    const BlockedSamples &from;
    const SampleColours &colours;
    Range range;
    std::size_t sample = 0, block = 0;
};

void place_samples(Stripe &stripe, std::size_t groups, const Placed &what) {
    const BlockedSamples &from = what.from;
    parallel_for(what.range.blocks(), [&](std::size_t b) {
        const SampleBlock &block = from.blocks[what.range.first_block + b];
        for (std::uint32_t i = block.begin; i < block.end; ++i) {
            const std::size_t to = i - what.range.first(from) + what.sample;
            stripe.places[to] = {from.x[i], from.y[i]};
            stripe.uppers[to] = from.upper[i];
            stripe.cocs[to] = from.hiding_coc()[i];
            stripe.alphas[to] = from.alpha[i];
            if (!stripe.shown.empty()) stripe.shown[to] = from.coc[i];
            for (std::size_t g = 0; g < groups; ++g)
                std::copy_n(&what.colours.group(g)[i * std::size_t{4}], 4,
                            &stripe.colours[(g * stripe.alphas.size() + to) * 4]);
        }
    });
}

void place_blocks(Stripe &stripe, const Placed &what) {
    const auto moved = [&](std::uint32_t sample) {
        return std::uint32_t(sample - what.range.first(what.from) + what.sample);
    };
    for (std::size_t b = 0; b < what.range.blocks(); ++b) {
        const SampleBlock &from = what.from.blocks[what.range.first_block + b];
        stripe.blocks.push_back({moved(from.begin), moved(from.opaque_end), from.x_min, from.x_max,
                                 from.y_min, from.y_max, from.coc_min, from.coc_max});
    }
}

// Lists blocks of a range. `first`: the stripe's number of the range's first block.
std::uint32_t list_blocks(Stripe &stripe, const Range &range, std::size_t first,
                          std::span<const std::uint32_t> blocks) {
    const auto at = std::uint32_t(stripe.block_lists.size());
    for (const std::uint32_t b : blocks)
        stripe.block_lists.push_back(std::uint32_t(b - range.first_block + first));
    return at;
}

// Places the solids behind all samples. `first_sample`: the scene's number of the stripe's first sample.
void place_solids(Stripe &stripe, const BlockedSamples &from, const Range &range,
                  std::uint32_t first_sample) {
    const std::uint32_t first = range.first(from);
    stripe.solids.resize(range.count(from));
    parallel_ranges(stripe.solids.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            const std::size_t i = first + n, to = stripe.alphas.size() + n;
            stripe.places[to] = {from.x[i], from.y[i]};
            stripe.uppers[to] = from.upper[i];
            stripe.cocs[to] = from.coc[i];
            stripe.solids[n] = from.named[i] - first_sample;
        }
    });
}

void place_facets(Stripe &stripe, const PlacedFacets &from, const Range &range, std::uint32_t first_sample) {
    const std::uint32_t first = range.first(from);
    stripe.facets.resize(3 * range.count(from));
    for (std::size_t i = 0; i < range.count(from); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            stripe.facets[3 * i + k] = std::uint32_t(from.key[k][first + i]) - first_sample;
    for (std::size_t b = 0; b < range.blocks(); ++b) {
        const FacetBlock &block = from.blocks[range.first_block + b];
        stripe.blocks.push_back({block.begin - first, block.end - first, block.x_min, block.x_max,
                                 block.y_min, block.y_max, block.coc_min, block.coc_max});
    }
}

// Places the lens points, which tiles share.
std::uint32_t place_lens(Stripe &stripe, std::span<const LensSample> lens) {
    const auto at = std::uint32_t(stripe.lens.size());
    float before = 0;
    for (const LensSample &p : lens) {
        stripe.lens.push_back({p.x, p.y, p.pixel_x, p.pixel_y, p.weight, p.rgb[0], p.rgb[1], p.rgb[2],
                               p.behind[0], p.behind[1], p.behind[2], p.in_front[0], p.in_front[1],
                               p.in_front[2], before});
        before += p.weight;
    }
    return at;
}

// Lists the tiles, and the blocks that reach each of them. The columns and the holdout are filled in later.
void list_tiles(Stripe &stripe, const GatherScene &scene, std::span<const TileTask> tasks,
                const Ranges &ranges, double most_turns) {
    const std::size_t fillers = ranges.samples.blocks(), solids = fillers + ranges.fillers.blocks(),
                      facets = solids + ranges.solids.blocks();
    const auto count = [](std::span<const std::uint32_t> list) { return std::uint32_t(list.size()); };
    std::uint32_t lens = 0, columns = 0, holdout = 0, rules = 0;
    const auto shows_images = [&](std::uint32_t block) { return scene.samples.blocks[block].shows_images; };
    for (const TileTask &task : tasks) {
        const bool another = &task == tasks.data() || task.lens.data() != (&task - 1)->lens.data();
        if (another) lens = place_lens(stripe, task.lens);
        if (another) rules = rules_of(scene, task.lens);
        const bool mirrors = std::ranges::any_of(task.samples, shows_images);
        stripe.tiles.push_back(
            {.x = float(task.origin.x),
             .y = float(task.origin.y),
             .blocks = list_blocks(stripe, ranges.samples, 0, task.samples),
             .block_count = count(task.samples),
             .fillers = list_blocks(stripe, ranges.fillers, fillers, task.fillers),
             .filler_count = count(task.fillers),
             .partial = {},
             .partial_count = {},
             .lens = lens,
             .lens_count = std::uint32_t(task.lens.size()),
             .lens_in_pass = std::uint32_t(std::clamp(most_turns / turns_of(scene, task), 1.0, 1e6)),
             .facets = list_blocks(stripe, ranges.facets, facets, task.facets),
             .facet_count = count(task.facets),
             .rules = rules | (mirrors ? lens_kernel::images : 0),
             .columns = columns,
             .holdout = holdout,
             .solids = list_blocks(stripe, ranges.solids, solids, task.solids),
             .solid_count = count(task.solids)});
        columns += std::uint32_t(column_words(scene, task));
        holdout += std::uint32_t(holdout_words(scene, task));
    }
    stripe.columns.resize(columns);
    stripe.holdout.resize(holdout);
}

// Lists the partial samples of each quarter.
void list_partial(Stripe &stripe, const BlockedSamples &samples, std::span<const TileTask> tasks,
                  std::uint32_t first_sample) {
    std::vector<PartialLists> lists(tasks.size());
    parallel_for(tasks.size(), [&](std::size_t t) { lists[t] = partial_lists(samples, tasks[t]); });
    for (std::size_t t = 0; t < tasks.size(); ++t)
        for (std::size_t q = 0; q < lens_kernel::quarters; ++q) {
            stripe.tiles[t].partial[q] = std::uint32_t(stripe.partial_lists.size());
            stripe.tiles[t].partial_count[q] = std::uint32_t(lists[t][q].size());
            for (const std::uint32_t i : lists[t][q]) stripe.partial_lists.push_back(i - first_sample);
            lists[t][q] = {};
        }
}

} // namespace

std::size_t tasks_that_fit(const GatherScene &scene, std::span<const TileTask> tasks, std::size_t bytes) {
    const std::size_t groups = scene.colours.groups;
    Ranges ranges;
    std::size_t listed = 0, partial = 0, lens = 0, columns = 0, holdout = 0;
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        ranges.add(scene, tasks[t]);
        listed += tasks[t].samples.size() + tasks[t].fillers.size() + tasks[t].facets.size() +
                  tasks[t].solids.size();
        partial += partial_count(scene.samples, tasks[t]);
        if (t == 0 || tasks[t].lens.data() != tasks[t - 1].lens.data()) lens += tasks[t].lens.size();
        columns += column_words(scene, tasks[t]);
        holdout += holdout_words(scene, tasks[t]);
        const std::size_t most =
            std::max({ranges.sample_count(scene) * groups * 16, ranges.facets.count(scene.facets) * 12,
                      listed * 4, partial * 4 * lens_kernel::quarters, columns * 4, holdout * 4,
                      lens * sizeof(lens_kernel::Lens), (t + 1) * tile_pixels * groups * 32});
        if (most > bytes) return t;
    }
    return tasks.size();
}

double turns_of(const GatherScene &scene, const TileTask &task) {
    const auto blocks =
        double(task.samples.size() + task.fillers.size() + task.solids.size() + 4 * task.facets.size());
    return 100 + blocks + double(partial_count(scene.samples, task)) / 4;
}

bool fits_whole(const GatherScene &scene, std::span<const TileTask> tasks, std::size_t bytes) {
    Ranges all, needed;
    all.add_all(scene);
    for (const TileTask &task : tasks) needed.add(scene, task);
    const std::size_t count = all.sample_count(scene);
    return count * scene.colours.groups * 16 <= bytes && all.facets.count(scene.facets) * 12 <= bytes &&
           2 * needed.sample_count(scene) >= count;
}

Stripe make_stripe(const GatherScene &scene, std::span<const TileTask> tasks, bool whole, double most_turns) {
    Stripe stripe;
    Ranges ranges;
    if (whole)
        ranges.add_all(scene);
    else
        for (const TileTask &task : tasks) ranges.add(scene, task);
    const std::size_t groups = scene.colours.groups, count = ranges.sample_count(scene);
    const Placed samples{scene.samples, scene.colours, ranges.samples},
        fillers{scene.fillers.samples, scene.fillers.colours, ranges.fillers,
                ranges.samples.count(scene.samples), ranges.samples.blocks()};
    stripe.sets.assign(scene.colours.sets.begin(), scene.colours.sets.end());
    stripe.places.resize(count + ranges.solids.count(scene.solids));
    stripe.uppers.resize(stripe.places.size());
    stripe.cocs.resize(stripe.places.size());
    stripe.alphas.resize(count);
    if (!scene.samples.surface_coc.empty() || !scene.fillers.samples.surface_coc.empty())
        stripe.shown.resize(count);
    stripe.first_filler = fillers.sample;
    stripe.colours.resize(groups * count * 4);
    for (const Placed &what : {samples, fillers}) {
        place_samples(stripe, groups, what);
        place_blocks(stripe, what);
    }
    place_solids(stripe, scene.solids, ranges.solids, ranges.samples.first(scene.samples));
    place_blocks(stripe, {scene.solids, scene.colours, ranges.solids, count});
    place_facets(stripe, scene.facets, ranges.facets, ranges.samples.first(scene.samples));
    list_tiles(stripe, scene, tasks, ranges, most_turns);
    list_partial(stripe, scene.samples, tasks, ranges.samples.first(scene.samples));
    parallel_for(tasks.size(), [&](std::size_t t) {
        const lens_kernel::Tile &tile = stripe.tiles[t];
        place_columns(std::span(stripe.columns).subspan(tile.columns, column_words(scene, tasks[t])), scene,
                      tasks[t]);
        place_holdout(std::span(stripe.holdout).subspan(tile.holdout, holdout_words(scene, tasks[t])), scene,
                      tasks[t]);
    });
    return stripe;
}

} // namespace sparselens::gpu
