#include "gpu/lens/scene_arrays.h"

#include "base/parallel.h"

#include <algorithm>

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

} // namespace

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

} // namespace sparselens::gpu
