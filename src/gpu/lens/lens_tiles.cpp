#include "gpu/lens/lens_tiles.h"

#include "base/grid.h"
#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace sparselens::gpu {

namespace {

// Returns the number of samples or facets of all blocks, which are stored one block after the other.
std::size_t count_of(const auto &of) { return of.blocks.empty() ? 0 : of.blocks.back().end; }

// Places samples from `first` on.
void place(SceneArrays &arrays, const BlockedSamples &from, std::size_t first, std::uint32_t hiding) {
    parallel_ranges(count_of(from), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            arrays.places[first + i] = {from.x[i], from.y[i]};
            arrays.uppers[first + i] = from.upper[i] | hiding;
            arrays.cocs[first + i] = from.hiding_coc()[i];
        }
    });
    for (const SampleBlock &b : from.blocks)
        arrays.blocks.push_back({std::uint32_t(first) + b.begin, std::uint32_t(first) + b.opaque_end, b.x_min,
                                 b.x_max, b.y_min, b.y_max, b.coc_min, b.coc_max});
}

void colour(SceneArrays &arrays, const BlockedSamples &from, const SampleColours &colours,
            std::size_t first) {
    const std::size_t count = count_of(from);
    const auto copy = [](const auto &values, std::size_t numbers, std::vector<float> &to, std::size_t at) {
        std::copy_n(values.begin(), numbers, to.begin() + std::ptrdiff_t(at));
    };
    copy(from.alpha, count, arrays.alphas, first);
    if (!arrays.shown.empty()) copy(from.coc, count, arrays.shown, first);
    parallel_for(colours.groups, [&](std::size_t g) {
        copy(colours.group(g), 4 * count, arrays.colours, (g * arrays.alphas.size() + first) * 4);
    });
}

void place_facets(SceneArrays &arrays, const PlacedFacets &from) {
    arrays.facets.resize(3 * count_of(from));
    for (std::size_t i = 0; i < arrays.facets.size(); ++i) arrays.facets[i] = from.sample[i % 3][i / 3];
    for (const FacetBlock &b : from.blocks)
        arrays.blocks.push_back({b.begin, b.end, b.x_min, b.x_max, b.y_min, b.y_max, b.coc_min, b.coc_max});
}

SceneArrays arrays_of(const GatherScene &scene) {
    const BlockedSamples &samples = scene.samples, &fillers = scene.fillers.samples, &solids = scene.solids;
    const std::size_t first_filler = count_of(samples), count = first_filler + count_of(fillers);
    SceneArrays arrays;
    arrays.places.resize(count + count_of(solids));
    arrays.uppers.resize(arrays.places.size());
    arrays.cocs.resize(arrays.places.size());
    arrays.alphas.resize(count);
    if (!samples.surface_coc.empty() || !fillers.surface_coc.empty()) arrays.shown.resize(count);
    arrays.colours.resize(scene.colours.groups * count * 4);
    place(arrays, samples, 0, lens_kernel::hiding);
    place(arrays, fillers, first_filler, 0);
    place(arrays, solids, count, lens_kernel::hiding);
    place_facets(arrays, scene.facets);
    colour(arrays, samples, scene.colours, 0);
    colour(arrays, fillers, scene.fillers.colours, first_filler);
    arrays.solids.assign(solids.named.begin(), solids.named.begin() + std::ptrdiff_t(count_of(solids)));
    arrays.sets.assign(scene.colours.sets.begin(), scene.colours.sets.end());
    return arrays;
}

using Bytes = std::span<const std::byte>;

// Bytes that are compared and copied at once: the colours of a block of pixels.
constexpr std::size_t page = 1024;
constexpr std::size_t cocs = 2, shown = 3; // indices of parts_of()

Bytes bytes(const auto &values) { return std::as_bytes(std::span(values)); }

// The arrays in the order of the shader's bindings: those of a scene, then those of a stripe.
std::array<Bytes, 10> parts_of(const SceneArrays &a) {
    return {bytes(a.places),  bytes(a.uppers), bytes(a.cocs),   bytes(a.shown),  bytes(a.alphas),
            bytes(a.colours), bytes(a.solids), bytes(a.facets), bytes(a.blocks), bytes(a.sets)};
}
std::array<Bytes, 6> parts_of(const TileLists &a) {
    return {bytes(a.blocks),  bytes(a.partial), bytes(a.lens),
            bytes(a.columns), bytes(a.holdout), bytes(a.tiles)};
}

// The ranges where two arrays differ, in whole pages.
std::vector<ByteRange> changes(Bytes before, Bytes now) {
    std::vector<char> differs(pieces_of(now.size(), page));
    parallel_ranges(differs.size(), 256, [&](std::size_t first, std::size_t last) {
        for (std::size_t n = first; n < last; ++n) {
            const std::size_t begin = n * page, end = std::min(begin + page, now.size());
            differs[n] = end > before.size() || std::memcmp(&before[begin], &now[begin], end - begin) != 0;
        }
    });
    std::vector<ByteRange> ranges;
    for (std::size_t n = 0; n < differs.size(); ++n) {
        if (!differs[n]) continue;
        const std::size_t begin = n * page, end = std::min(begin + page, now.size());
        if (!ranges.empty() && ranges.back().end == begin)
            ranges.back().end = end;
        else
            ranges.push_back({begin, end});
    }
    return ranges;
}

constexpr std::uint32_t code[] = {
#include <lens_tile.comp.inc>
};

constexpr std::size_t tiles_at_once = 512; // limits the memory of their lists
// Threads of a work group. In software, threads that have nothing to do cost as much as the others.
std::uint32_t threads_on(const Device &device) { return device.info().kind == Kind::software ? 32 : 256; }

// Lens points that a work group takes at once, by its shared memory (tile_data.glsl). More than four gain little, and
// in software more than three take more turns of loops than turns_of() counts.
std::uint32_t points_at_once(const Device &device, std::uint32_t rules) {
    const std::size_t cells = ((rules & lens_kernel::images) != 0 ? 2 : 1) * lens_kernel::cells,
                      of_point = cells * sizeof(std::uint32_t) + lens_kernel::chunk * sizeof(std::uint32_t),
                      others = threads_on(device) * 5 * sizeof(std::uint32_t) + 64;
    const std::size_t most = device.info().kind == Kind::software ? 3 : 4;
    return std::uint32_t(std::clamp((device.shared_bytes() - others) / of_point, std::size_t{1}, most));
}

// Sorts lens points so that each group of `points` consecutive ones lies close together: in bands from side to side of
// the lens, back and forth. Points without weight fill up the last group.
std::vector<LensSample> in_groups(std::span<const LensSample> lens, std::size_t points) {
    std::vector<LensSample> all(lens.begin(), lens.end());
    const auto [top, bottom] = std::ranges::minmax(all, {}, &LensSample::y);
    const float bands = std::sqrt(float(all.size()) / float(points)), high = (bottom.y - top.y) / bands;
    const auto place = [&, first = top.y](const LensSample &p) {
        const float band = high > 0 ? std::floor((p.y - first) / high) : 0;
        return std::pair(band, std::fmod(band, 2.0f) > 0 ? -p.x : p.x);
    };
    std::ranges::stable_sort(all, {}, place);
    LensSample none = all.back();
    none.weight = 0;
    all.resize(pieces_of(all.size(), points) * points, none);
    return all;
}

} // namespace

const Program &LensTilesOnDevice::program_for(std::uint32_t rules, std::uint32_t points) {
    const std::array constants{threads_on(device_), points, rules};
    if (!programs_.contains(rules))
        programs_.emplace(rules, device_.program("lens", code, 19, sizeof(lens_kernel::Push), constants));
    return programs_.at(rules);
}

void LensTilesOnDevice::gather(const GatherScene &scene, std::span<const TileTask> all,
                               const std::function<void(std::size_t, const TilePicture &)> &done) {
    const std::uint32_t rules = rules_of(scene, all), points = points_at_once(device_, rules);
    std::map<const LensSample *, std::vector<LensSample>> lens; // by those of the tasks
    std::vector<TileTask> taken;
    std::vector<std::size_t> numbers; // the number of each task among all tasks
    for (std::size_t n = 0; n < all.size(); ++n) {
        if (turns_of(scene, all[n]) > device_.most_turns()) {
            ++worker_.report.on_cpu["more steps than the device takes"];
            continue;
        }
        taken.push_back(all[n]);
        numbers.push_back(n);
        std::vector<LensSample> &grouped = lens[all[n].lens.data()];
        if (grouped.empty()) grouped = in_groups(all[n].lens, points);
        taken.back().lens = grouped;
    }
    const std::span<const TileTask> tasks = taken;
    if (tasks.empty()) return;
    OnDevice<SceneArrays> &from = scenes_[scene.coarse ? 1 : 0];
    bring(from, arrays_of(scene));
    const Program &program = program_for(rules, points);
    const auto work = [&](std::size_t begin, std::size_t count) -> const char * {
        bring(lists_, lists_of(scene, tasks.subspan(begin, count), points, device_.most_turns()));
        gather_stripe(scene, program, from,
                      [&](std::size_t t, const TilePicture &picture) { done(numbers[begin + t], picture); });
        return nullptr;
    };
    worker_.by_stripes(tasks.size(), tiles_at_once, work);
}

template <class Arrays>
void LensTilesOnDevice::bring(OnDevice<Arrays> &there, Arrays arrays) {
    OnDevice<Arrays> next = std::exchange(there, {}); // after a failure, nothing is there
    const auto before = parts_of(next.arrays), now = parts_of(arrays);
    std::array<std::size_t, std::tuple_size_v<decltype(now)>> sizes;
    std::array<bool, sizes.size()> stays{};
    for (std::size_t part = 0; part < sizes.size(); ++part) {
        sizes[part] = now[part].size();
        stays[part] = part < next.buffers.size() && sizes[part] <= next.buffers[part].bytes;
    }
    device_.make_room(next.buffers, sizes);
    for (std::size_t part = 0; part < sizes.size(); ++part) {
        const std::vector<ByteRange> changed = changes(stays[part] ? before[part] : Bytes{}, now[part]);
        device_.upload(next.buffers[part], now[part], changed);
        for (const ByteRange &range : changed) worker_.report.uploaded += range.end - range.begin;
    }
    next.arrays = std::move(arrays);
    there = std::move(next);
}

void LensTilesOnDevice::gather_stripe(const GatherScene &scene, const Program &program,
                                      const OnDevice<SceneArrays> &from,
                                      const std::function<void(std::size_t, const TilePicture &)> &done) {
    const std::vector<lens_kernel::Tile> &tiles = lists_.arrays.tiles;
    const std::size_t groups = scene.colours.groups, all = tiles.size() * tile_pixels * groups;
    const std::uint32_t passes = lists_.arrays.passes;
    std::vector<Buffer> buffers = from.buffers;
    if (from.arrays.shown.empty()) buffers[shown] = buffers[cocs];
    buffers.insert(buffers.end(), lists_.buffers.begin(), lists_.buffers.end());
    device_.make_room(made_, std::array{all * 4 * sizeof(float), all * sizeof(float),
                                        passes > 1 ? all * 8 * sizeof(float) : 0});
    buffers.insert(buffers.end(), made_.begin(), made_.end());
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        if (pass > 0) device_.finish();
        const lens_kernel::Push push{std::uint32_t(tiles.size()), std::uint32_t(from.arrays.alphas.size()),
                                     pass, float(scene.held_out.depth_at_1)};
        device_.run(program, buffers, std::as_bytes(std::span(&push, 1)),
                    {lens_kernel::quarters * push.tile_count, std::uint32_t(groups), 1});
    }
    std::vector<float> value(all * 4), knowns(all);
    device_.finish(std::array{Download{std::as_writable_bytes(std::span(value)), made_[0]},
                              Download{std::as_writable_bytes(std::span(knowns)), made_[1]}});
    parallel_for(tiles.size(), [&](std::size_t t) {
        done(t,
             {&value[t * tile_pixels * 4], &knowns[t * tile_pixels], groups, tiles.size() * tile_pixels * 4});
    });
}

} // namespace sparselens::gpu
