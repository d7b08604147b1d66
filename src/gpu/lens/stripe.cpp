#include "gpu/lens/stripe.h"

#include "base/parallel.h"
#include "deep/merge.h"
#include "dof/device/tile_device.h"
#include "dof/lens/gather_scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens::gpu {

// Finds which blocks of a scene tiles are gathered from.

// A range of blocks, and of the samples or facets in them, which follow each other.
struct Range {
    std::uint32_t first_block = ~0u, end_block = 0;

    void add(std::uint32_t first, std::uint32_t last) {
        first_block = std::min(first_block, first);
        end_block = std::max(end_block, last + 1);
    }
    void add(std::span<const std::uint32_t> blocks) { // in ascending order
        if (!blocks.empty()) add(blocks.front(), blocks.back());
    }
    void add_all(const auto &of) {
        if (!of.blocks.empty()) add(0, std::uint32_t(of.blocks.size() - 1));
    }
    std::size_t blocks() const { return first_block < end_block ? end_block - first_block : 0; }
    std::uint32_t first(const auto &of) const { return blocks() > 0 ? of.blocks[first_block].begin : 0; }
    std::size_t count(const auto &of) const {
        return blocks() > 0 ? of.blocks[end_block - 1].end - first(of) : 0;
    }
};

// The ranges of a scene that tiles are gathered from.
struct Ranges {
    Range samples, fillers, facets, solids;

    void add(const GatherScene &scene, const TileTask &task) {
        samples.add(task.samples);
        fillers.add(task.fillers);
        facets.add(task.facets);
        solids.add(task.solids);
        for (const std::uint32_t b : task.facets)
            for (const auto &corners : scene.facets.key) add_named(scene, corners, scene.facets.blocks[b]);
        for (const std::uint32_t b : task.solids)
            add_named(scene, scene.solids.named, scene.solids.blocks[b]);
    }
    void add_all(const GatherScene &scene) {
        samples.add_all(scene.samples);
        fillers.add_all(scene.fillers.samples);
        facets.add_all(scene.facets);
        solids.add_all(scene.solids);
    }
    std::size_t sample_count(const GatherScene &scene) const {
        return samples.count(scene.samples) + fillers.count(scene.fillers.samples);
    }

private:
    // Adds the samples that the lower halves of a block's keys name (`keys`). A facet can reach a tile that some of its
    // corners do not reach, and a solid can reach a tile that the sample which it shows does not reach.
    void add_named(const GatherScene &scene, const auto &keys, const auto &block) {
        std::uint32_t least = ~0u, most = 0;
        for (std::uint32_t i = block.begin; i < block.end; ++i) {
            least = std::min(least, std::uint32_t(keys[i]));
            most = std::max(most, std::uint32_t(keys[i]));
        }
        if (least <= most) samples.add(block_of(scene.samples, least), block_of(scene.samples, most));
    }
    static std::uint32_t block_of(const BlockedSamples &samples, std::uint32_t sample) {
        const auto after = std::ranges::upper_bound(samples.blocks, sample, {}, &SampleBlock::begin);
        return std::uint32_t(after - samples.blocks.begin() - 1);
    }
};

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
    std::uint32_t hiding = 0; // for the upper halves of keys
};

void place_samples(Stripe &stripe, std::size_t groups, const Placed &what) {
    const BlockedSamples &from = what.from;
    parallel_for(what.range.blocks(), [&](std::size_t b) {
        const SampleBlock &block = from.blocks[what.range.first_block + b];
        for (std::uint32_t i = block.begin; i < block.end; ++i) {
            const std::size_t to = i - what.range.first(from) + what.sample;
            stripe.places[to] = {from.x[i], from.y[i]};
            stripe.uppers[to] = from.upper[i] | what.hiding;
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
            stripe.uppers[to] = from.upper[i] | lens_kernel::hiding;
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
    for (const LensSample &p : lens)
        stripe.lens.push_back({p.x, p.y, p.pixel_x, p.pixel_y, p.weight, p.rgb[0], p.rgb[1], p.rgb[2],
                               p.behind[0], p.behind[1], p.behind[2], p.in_front[0], p.in_front[1],
                               p.in_front[2]});
    return at;
}

// Lists the tiles, and the blocks that reach each of them. The columns and the holdout are filled in later.
void list_tiles(Stripe &stripe, const GatherScene &scene, std::span<const TileTask> tasks,
                const Ranges &ranges, std::uint32_t points, double most_turns) {
    const std::size_t fillers = ranges.samples.blocks(), solids = fillers + ranges.fillers.blocks(),
                      facets = solids + ranges.solids.blocks();
    const auto count = [](std::span<const std::uint32_t> list) { return std::uint32_t(list.size()); };
    std::uint32_t lens = 0, columns = 0, holdout = 0;
    float weight = 0;
    for (const TileTask &task : tasks) {
        const bool another = &task == tasks.data() || task.lens.data() != (&task - 1)->lens.data();
        if (another) {
            lens = place_lens(stripe, task.lens);
            weight = 0;
            for (const LensSample &p : task.lens) weight += p.weight;
        }
        const std::uint32_t blocks = list_blocks(stripe, ranges.samples, 0, task.samples);
        list_blocks(stripe, ranges.fillers, fillers, task.fillers);
        stripe.tiles.push_back(
            {.x = float(task.origin.x),
             .y = float(task.origin.y),
             .size = task.size,
             .weight = weight,
             .blocks = blocks,
             .block_count = count(task.samples),
             .filler_count = count(task.fillers),
             .partial = {},
             .partial_count = {},
             .lens = lens,
             .lens_count = std::uint32_t(task.lens.size()),
             .lens_in_pass = points * std::uint32_t(std::clamp(most_turns / turns_of(scene, task), 1.0, 1e6)),
             .facets = list_blocks(stripe, ranges.facets, facets, task.facets),
             .facet_count = count(task.facets),
             .solids = list_blocks(stripe, ranges.solids, solids, task.solids),
             .solid_count = count(task.solids),
             .columns = columns,
             .holdout = holdout});
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
    const auto turns = [](const auto &blocks, std::span<const std::uint32_t> of) {
        double sum = 0;
        for (const std::uint32_t b : of) sum += 2 + double(blocks[b].end - blocks[b].begin) / 32;
        return sum;
    };
    return 800 + turns(scene.samples.blocks, task.samples) +
           turns(scene.fillers.samples.blocks, task.fillers) + 3 * turns(scene.solids.blocks, task.solids) +
           12 * turns(scene.facets.blocks, task.facets) + double(partial_count(scene.samples, task));
}

bool fits_whole(const GatherScene &scene, std::span<const TileTask> tasks, std::size_t bytes) {
    Ranges all, needed;
    all.add_all(scene);
    for (const TileTask &task : tasks) needed.add(scene, task);
    const std::size_t count = all.sample_count(scene);
    return count * scene.colours.groups * 16 <= bytes && all.facets.count(scene.facets) * 12 <= bytes &&
           2 * needed.sample_count(scene) >= count;
}

Stripe make_stripe(const GatherScene &scene, std::span<const TileTask> tasks, bool whole,
                   std::uint32_t points, double most_turns) {
    Stripe stripe;
    Ranges ranges;
    if (whole)
        ranges.add_all(scene);
    else
        for (const TileTask &task : tasks) ranges.add(scene, task);
    const std::size_t groups = scene.colours.groups, count = ranges.sample_count(scene);
    const Placed samples{scene.samples, scene.colours, ranges.samples, 0, 0, lens_kernel::hiding},
        fillers{scene.fillers.samples, scene.fillers.colours, ranges.fillers,
                ranges.samples.count(scene.samples), ranges.samples.blocks()};
    stripe.sets.assign(scene.colours.sets.begin(), scene.colours.sets.end());
    stripe.places.resize(count + ranges.solids.count(scene.solids));
    stripe.uppers.resize(stripe.places.size());
    stripe.cocs.resize(stripe.places.size());
    stripe.alphas.resize(count);
    if (!scene.samples.surface_coc.empty() || !scene.fillers.samples.surface_coc.empty())
        stripe.shown.resize(count);
    stripe.colours.resize(groups * count * 4);
    for (const Placed &what : {samples, fillers}) {
        place_samples(stripe, groups, what);
        place_blocks(stripe, what);
    }
    place_solids(stripe, scene.solids, ranges.solids, ranges.samples.first(scene.samples));
    place_blocks(stripe, {scene.solids, scene.colours, ranges.solids, count});
    place_facets(stripe, scene.facets, ranges.facets, ranges.samples.first(scene.samples));
    list_tiles(stripe, scene, tasks, ranges, points, most_turns);
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

using namespace lens_kernel;

namespace {

constexpr int rows_a_word = 2;
constexpr std::size_t words_a_lens_point = tile_size / rows_a_word;
constexpr std::size_t words_a_part = 3;

} // namespace

std::uint32_t rules_of(const GatherScene &scene, std::span<const TileTask> tasks) {
    std::uint32_t rules = 0;
    for (const TileTask &task : tasks) {
        if (&task == tasks.data() || task.lens.data() != (&task - 1)->lens.data())
            for (const LensSample &p : task.lens) {
                if (p.rgb != no_factors) rules |= weighted;
                if (p.behind != no_factors || p.in_front != no_factors) rules |= weighted | two_sided;
            }
        for (const std::uint32_t b : task.samples) {
            const SampleBlock &block = scene.samples.blocks[b];
            if (block.shows_images) rules |= images;
            if (block.opaque_end != block.end) rules |= with_partial;
        }
        if (!task.facets.empty()) rules |= with_facets;
        if (!task.solids.empty()) rules |= with_solids;
    }
    if (scene.cat_eye()) rules |= weighted | cat_eye;
    if (scene.cat_eye() && scene.cat_eye()->darkens()) rules |= darkens;
    if (scene.held_out.by) rules |= holdout;
    return rules;
}

std::size_t column_words(const GatherScene &scene, const TileTask &task) {
    return scene.cat_eye() ? task.lens.size() * words_a_lens_point : 0;
}

void place_columns(std::span<std::uint32_t> to, const GatherScene &scene, const TileTask &task) {
    const Imath::V2i first = scene.held_out.corner + task.origin;
    for (std::size_t word = 0; word < to.size(); ++word) {
        const LensSample &point = task.lens[word / words_a_lens_point];
        to[word] = 0;
        for (int row = 0; row < rows_a_word; ++row) {
            const int y = int(word % words_a_lens_point) * rows_a_word + row;
            const auto [begin, end] = scene.cat_eye()->columns(point, first.x, tile_size, first.y + y);
            to[word] |= std::uint32_t(begin | end << 8) << 16 * row;
        }
    }
}

std::size_t holdout_words(const GatherScene &scene, const TileTask &task) {
    if (!scene.held_out.by) return 0;
    const Imath::V2i first = scene.held_out.corner + task.origin;
    return tile_pixels + 1 +
           words_a_part * scene.held_out.by->parts_in({first, first + Imath::V2i(tile_size - 1)});
}

void place_holdout(std::span<std::uint32_t> to, const GatherScene &scene, const TileTask &task) {
    if (!scene.held_out.by) return;
    const Imath::V2i first = scene.held_out.corner + task.origin;
    std::vector<Holdout::Part> parts;
    for (int y = 0; y < tile_size; ++y)
        for (int x = 0; x < tile_size; ++x) {
            to[std::size_t(y * tile_size + x)] = std::uint32_t(parts.size());
            scene.held_out.by->append_parts(first.x + x, first.y + y, parts);
        }
    to[tile_pixels] = std::uint32_t(parts.size());
    std::uint32_t *word = &to[tile_pixels + 1];
    for (const Holdout::Part &part : parts)
        for (const float value : {part.front, part.back, part.clear})
            *word++ = std::bit_cast<std::uint32_t>(value);
}

namespace {

constexpr float margin = 2; // pixels: those next to the quarter, and rounding
constexpr float size = lens_kernel::size;

// How far lens points move a sample: per pixel of CoC, and besides.
struct Reach {
    float x = 0, y = 0, all = 0;
};

Reach reach_of(const TileTask &task) {
    Reach reach;
    for (const LensSample &p : task.lens) {
        reach.x = std::max(reach.x, std::abs(p.x));
        reach.y = std::max(reach.y, std::abs(p.y));
        reach.all = std::max({reach.all, std::abs(p.pixel_x), std::abs(p.pixel_y)});
    }
    return reach;
}

bool within(float at, float first, float reach) { return at > first - reach && at < first + size + reach; }

} // namespace

PartialLists partial_lists(const BlockedSamples &samples, const TileTask &task) {
    const Reach reach = reach_of(task);
    std::vector<std::uint32_t> sorted;
    for (const std::uint32_t b : task.samples)
        for (std::uint32_t i = samples.blocks[b].opaque_end; i < samples.blocks[b].end; ++i)
            sorted.push_back(i);
    std::ranges::sort(sorted, [&](std::uint32_t a, std::uint32_t b) {
        return samples.depth(a) != samples.depth(b) ? samples.depth(a) > samples.depth(b) : a < b;
    });
    PartialLists lists;
    for (const std::uint32_t i : sorted) {
        const float coc = std::abs(samples.hiding_coc()[i]), beside = reach.all + margin,
                    across = coc * reach.x + beside, down = coc * reach.y + beside;
        for (std::size_t q = 0; q < lens_kernel::quarters; ++q) {
            const float left = float(task.origin.x) + float(q % 2) * size,
                        top = float(task.origin.y) + float(q / 2) * size;
            if (within(samples.x[i], left, across) && within(samples.y[i], top, down)) lists[q].push_back(i);
        }
    }
    return lists;
}

} // namespace sparselens::gpu
