#include "gpu/lens/tile_rules.h"

#include "deep/holdout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace sparselens::gpu {

using namespace lens_kernel;

namespace {

constexpr int rows_a_word = 2;
constexpr std::size_t words_a_lens_point = tile_size / rows_a_word;
constexpr std::size_t words_a_part = 3;

} // namespace

std::uint32_t rules_of(const GatherScene &scene, std::span<const LensSample> lens) {
    const auto any = [&](const auto &is) { return std::ranges::any_of(lens, is); };
    std::uint32_t rules = 0;
    if (any([](const LensSample &p) { return p.rgb != no_factors; })) rules |= weighted;
    if (any([](const LensSample &p) { return p.behind != no_factors || p.in_front != no_factors; }))
        rules |= weighted | two_sided;
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
