#include "dof/lens/tile_samples.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace sparselens {

namespace {

// Sorts by depth, the nearest first, then by index.
std::uint64_t order_key(float depth, std::uint32_t sample) {
    return (std::uint64_t(~std::bit_cast<std::uint32_t>(depth)) << 32) | sample;
}

// Whether some lens point brings a sample at (x, y) into the tile, or next to it.
bool is_brought(const TileTask &tile, float x, float y, float coc) {
    constexpr float beside = tile_cells::border + 1; // 1: rounding
    const float least = -beside, most = float(tile.size) + beside;
    return std::ranges::any_of(tile.lens, [&](const LensSample &p) {
        const float column = x - float(tile.origin.x) + coc * p.x + p.pixel_x,
                    row = y - float(tile.origin.y) + coc * p.y + p.pixel_y;
        return column > least && column < most && row > least && row < most;
    });
}

// The largest CoC and disparity of the samples that lens points bring into a tile, pixels. Only very wide samples are
// tested, because one bad depth would make the units of all tiles coarse.
struct TileExtent {
    float coc = 0, depth = 0;

    void add(const TileTask &tile, const BlockedSamples &samples, const SampleBlock &block) {
        constexpr float tested_from = 1000; // pixels
        if (const float most = largest_coc_of(block); !(most > std::max(coc, tested_from))) {
            coc = std::max(coc, most);
            depth = std::max(depth, block.depth_max);
            return;
        }
        for (std::uint32_t i = block.begin; i < block.end; ++i)
            for (const float of : {samples.coc[i], samples.hiding_coc()[i]})
                if (!(std::abs(of) > std::max(coc, tested_from)) ||
                    is_brought(tile, samples.x[i], samples.y[i], of)) {
                    coc = std::max(coc, std::abs(of));
                    depth = std::max(depth, samples.depth(i));
                }
    }
};

} // namespace

LensReach::LensReach(std::span<const LensSample> lens) {
    for (const LensSample &p : lens) {
        x = std::max(x, std::abs(p.x));
        y = std::max(y, std::abs(p.y));
        beside = std::max(
            {beside, tile_cells::border + std::abs(p.pixel_x), tile_cells::border + std::abs(p.pixel_y)});
    }
}

bool LensReach::brings(const BlockedSamples &samples, std::uint32_t i, const Imath::V2i &corner,
                       int size) const {
    const float coc = std::abs(samples.coc[i]), across = coc * x + beside, down = coc * y + beside,
                column = samples.x[i] - float(corner.x), row = samples.y[i] - float(corner.y);
    return column > -across && column < float(size) + across && row > -down && row < float(size) + down;
}

std::vector<std::uint32_t> partial_in_reach(const BlockedSamples &samples, const TileTask &tile) {
    const LensReach reach(tile.lens);
    std::vector<std::uint64_t> order;
    for (const std::uint32_t b : tile.samples)
        for (std::uint32_t i = samples.blocks[b].opaque_end; i < samples.blocks[b].end; ++i)
            if (reach.brings(samples, i, tile.origin, tile.size))
                order.push_back(order_key(samples.depth(i), i));
    std::ranges::sort(order);
    return {order.begin(), order.end()}; // the lower half
}

TileNumbers number_tile(const GatherScene &scene, const TileTask &tile) {
    TileNumbers numbers;
    std::vector<NumberRun> &runs = numbers.runs;
    TileExtent extent;
    const auto measure = [&](const BlockedSamples &samples, std::span<const std::uint32_t> blocks) {
        for (const std::uint32_t b : blocks)
            if (samples.blocks[b].begin < samples.blocks[b].end) extent.add(tile, samples, samples.blocks[b]);
    };
    const auto add_blocks = [&](const BlockedSamples &samples, std::span<const std::uint32_t> blocks,
                                std::size_t first) {
        measure(samples, blocks);
        for (const std::uint32_t b : blocks) {
            const SampleBlock &block = samples.blocks[b];
            if (block.begin < block.opaque_end)
                runs.push_back(
                    {std::uint32_t(first) + block.begin, std::uint32_t(first) + block.opaque_end, 0});
        }
    };
    add_blocks(scene.samples, tile.samples, 0);
    std::vector<std::uint32_t> others;
    std::size_t last = 0;
    const auto need = [&](std::uint32_t i) {
        if (last < runs.size() && runs[last].has(i)) return;
        const auto after = std::ranges::upper_bound(runs, i, {}, &NumberRun::begin);
        if (after != runs.begin() && (after - 1)->has(i))
            last = std::size_t(after - runs.begin()) - 1;
        else
            others.push_back(i);
    };
    for (const std::uint32_t b : tile.facets)
        for (const auto &corners : scene.facets.sample)
            for (std::uint32_t f = scene.facets.blocks[b].begin; f < scene.facets.blocks[b].end; ++f)
                need(corners[f]);
    measure(scene.solids, tile.solids);
    for (const std::uint32_t b : tile.solids)
        for (std::uint32_t i = scene.solids.blocks[b].begin; i < scene.solids.blocks[b].opaque_end; ++i)
            need(scene.solids.named[i]);
    std::ranges::sort(others);
    others.erase(std::unique(others.begin(), others.end()), others.end());
    for (const std::uint32_t i : others) runs.push_back({i, i + 1, 0});
    std::ranges::sort(runs, {}, &NumberRun::begin);
    add_blocks(scene.fillers.samples, tile.fillers, scene.samples.count());
    std::uint32_t number = 0;
    std::for_each(runs.rbegin(), runs.rend(),
                  [&](NumberRun &run) { run.number = number += run.end - run.begin; });

    numbers.bits = int(std::bit_width(number));
    kernels::TileUnits &units = numbers.units = tile_units(extent.coc, tile.lens);
    constexpr float most_depth = 4096; // nothing is left of the shape of nearer things, nor of their order
    const float codes = 0.999f * float((std::uint32_t{1} << (31 - numbers.bits)) - 8); // .999: rounding
    units.nearest = std::min(extent.depth, most_depth);
    units.codes = codes / (units.nearest + kernels::behind_crack_px);
    units.image_codes = codes / (2 * units.farthest + 1);
    return numbers;
}

TileSamples::TileSamples(const GatherScene &scene, const TileTask &tile)
    : scene_(scene), tile_(tile), numbers_(number_tile(scene, tile)),
      middle_(Imath::V2f(tile.origin) + Imath::V2f(tile_cells::size / 2)) {
    const std::size_t numbers = numbers_.count();
    shown.resize(numbers);
    in_front.resize(numbers);
    colours_.resize(scene.colours.groups * numbers * 4);
    for (std::size_t g = 0; g < scene.colours.groups; ++g) std::fill_n(&colours_[g * numbers * 4], 4, 0.0f);
    for (const NumberRun &run : numbers_.runs) name(run);
    std::uint32_t farthest = ~0u, nearest = 0;
    for (const NumberRun &run : numbers_.runs)
        for (std::uint32_t i = run.begin; i < std::min(run.end, std::uint32_t(scene.samples.count())); ++i) {
            farthest = std::min(farthest, scene.samples.upper[i]);
            nearest = std::max(nearest, scene.samples.upper[i]);
        }
    is_deep = !tile.solids.empty() || code(nearest) > kernels::behind_crack(code(farthest), units().codes);
    place(opaque, scene.samples, scene.samples.hiding_coc(), tile.samples, 0);
    place(solids, scene.solids, scene.solids.coc, tile.solids, 0);
    const BlockedSamples &of_fillers = scene.fillers.samples;
    place(fillers, of_fillers, of_fillers.hiding_coc(), tile.fillers, scene.samples.count());
    for (const std::uint32_t b : tile.facets)
        for (std::uint32_t f = scene.facets.blocks[b].begin; f < scene.facets.blocks[b].end; ++f) {
            std::array<CellWord, 3> &words = facets.emplace_back();
            for (std::size_t k = 0; k < 3; ++k) {
                const CellWord n = number(scene.facets.sample[k][f]);
                words[k] = word_of(code(scene.samples.upper[scene.facets.sample[k][f]]), n);
            }
        }
    place_images();
    place_partial();
}

// Copies what the numbers of a run show. Backgrounds lie behind focus, wherever they are seen.
void TileSamples::name(const NumberRun &run) {
    const bool is_filler = run.begin >= scene_.samples.count();
    const BlockedSamples &samples = is_filler ? scene_.fillers.samples : scene_.samples;
    const SampleColours &colours = is_filler ? scene_.fillers.colours : scene_.colours;
    const std::size_t first = run.begin - (is_filler ? scene_.samples.count() : 0),
                      count = run.end - run.begin;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t n = run.number - i;
        const std::size_t s = first + i;
        shown[n] = {samples.x[s], samples.y[s], samples.depth(s), run.begin + std::uint32_t(i)};
        in_front[n] = samples.coc[s] < 0 && (is_filler || samples.upper[s] > kernels::background_upper);
    }
    for (std::size_t g = 0; g < scene_.colours.groups; ++g) {
        const float *from = &colours.group(g)[first * 4];
        float *to = &colours_[(g * shown.size() + run.number) * 4];
        for (std::size_t i = 0; i < count; ++i) std::memcpy(to - i * 4, from + i * 4, 4 * sizeof(float));
    }
}

CellWord TileSamples::number(std::uint32_t i) {
    if (!numbers_.runs[last_run_].has(i))
        last_run_ = std::size_t(std::ranges::upper_bound(numbers_.runs, i, {}, &NumberRun::begin) -
                                numbers_.runs.begin()) -
                    1;
    return CellWord(numbers_.runs[last_run_].number - (i - numbers_.runs[last_run_].begin));
}

std::uint32_t TileSamples::code(std::uint32_t of) const {
    return kernels::depth_code(of, units().nearest, units().codes);
}

// Places the opaque samples of some blocks. `offset`: the index of `samples`' first one among samples and fillers.
void TileSamples::place(PlacedWords &to, const BlockedSamples &samples, std::span<const float> coc,
                        std::span<const std::uint32_t> blocks, std::size_t offset) {
    for (const std::uint32_t b : blocks) {
        const std::uint32_t begin = samples.blocks[b].begin, end = samples.blocks[b].opaque_end;
        to.places.add(units(), middle_, samples.x.data() + begin, samples.y.data() + begin,
                      coc.data() + begin, end - begin);
        to.words.resize(to.places.count());
        for (std::uint32_t i = begin; i < end; ++i)
            to.words[to.begin.back() + i - begin] =
                word_of(code(samples.upper[i]),
                        number(samples.named.empty() ? std::uint32_t(offset) + i : samples.named[i]));
        to.begin.push_back(to.places.count());
    }
}

void TileSamples::place(PlacedWords &to, std::span<const std::uint32_t> list) {
    const BlockedSamples &samples = scene_.samples;
    std::vector<float> x, y, coc;
    for (const std::uint32_t i : list) {
        x.push_back(samples.x[i]);
        y.push_back(samples.y[i]);
        coc.push_back(samples.coc[i]);
    }
    to.places.add(units(), middle_, x.data(), y.data(), coc.data(), std::uint32_t(list.size()));
    to.words.resize(to.places.count());
}

void TileSamples::place_images() {
    std::vector<std::uint32_t> list;
    for (const std::uint32_t b : tile_.samples) {
        const SampleBlock &block = scene_.samples.blocks[b];
        for (std::uint32_t i = block.begin; block.shows_images && i < block.opaque_end; ++i)
            if (scene_.samples.is_image(i)) list.push_back(i);
    }
    place(images, list);
    for (std::size_t n = 0; n < list.size(); ++n)
        images.words[n] =
            word_of(kernels::image_code(scene_.samples.coc[list[n]], units().farthest, units().image_codes),
                    number(list[n]));
}

void TileSamples::place_partial() {
    const BlockedSamples &samples = scene_.samples;
    partial.sample = partial_in_reach(samples, tile_);
    place(partial.placed, partial.sample);
    for (std::size_t n = 0; n < partial.count(); ++n) {
        const std::uint32_t i = partial.sample[n];
        partial.coc.push_back(samples.coc[i]);
        partial.depth.push_back(samples.depth(i));
        partial.left.push_back(1 - samples.alpha[i]);
        partial.placed.words[n] = word_of(code(samples.upper[i]), number_mask());
    }
}

} // namespace sparselens
