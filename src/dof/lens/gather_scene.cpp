#include "dof/lens/gather_scene.h"

#include "dof/lens/sharpen.h"
#include "dof/lens/solid_samples.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace sparselens {

namespace {

bool is_sharp(const BlockedSamples &samples, const Optics &optics) {
    return !optics.moves() && !optics.field.skews() &&
           std::ranges::all_of(samples.blocks, [&](const SampleBlock &block) {
               return block.begin == block.end || largest_coc_of(block) * optics.widest() < in_focus;
           });
}

// The pixels that were seen, relative to the data window's corner.
std::optional<Imath::Box2i> seen_of(const LensGatherOptions &options, const Imath::V2i &corner) {
    if (!options.seen) return {};
    return Imath::Box2i(options.seen->min - corner, options.seen->max - corner);
}

// Half of it magenta, by its coverage.
void paint(SampleColours &colours, std::span<const ColourSet> sets, std::size_t alpha) {
    for (std::size_t k = 0; k < sets.size(); ++k) {
        if (!is_colour(sets[k])) continue;
        const float mark = (sets[k] & green) != 0 ? 0 : 0.5f;
        for (std::size_t i = 0; i < colours.count; ++i)
            colours.at(k, i) = colours.at(k, i) / 2 + mark * (alpha == npos ? 1 : colours.at(alpha, i));
    }
}

} // namespace

GatherScene prepare(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                    const LensGatherOptions &options, double coc, const Progress &progress) {
    const KnownPixels known(options.known.value_or(window), options.unseen);
    const Imath::V2i corner = ldi.windows.data.min;
    GatherScene scene{&ldi,
                      lens.pixel_aspect,
                      std::make_unique<Optics>(ldi, lens, options.looks, coc),
                      {options.holdout, perceptive_depth(lens, 1), corner},
                      make_blocks(ldi, lens, known),
                      {},
                      {},
                      {},
                      {}};
    const Optics &optics = *scene.optics;
    BlockedSamples &samples = scene.samples;
    optics.bend(samples);
    if (is_sharp(samples, optics)) return scene;
    progress.may_end();
    const std::vector<Filler> fillers =
        find_fillers(ldi, lens, known); // before there are colours, as it takes memory
    progress.may_end();
    scene.colours = make_colours(ldi, samples);
    if (!options.point) {
        const SharpenLooks looks{optics.aperture, optics.field, coc, options.seen};
        sharpen_near_focus(ldi, lens, samples, scene.colours, &looks);
        progress.may_end();
        const LightChannels light = light_channels(ldi);
        scene.highlights =
            take_highlights(samples, light.brightness, light.all, scene.colours, seen_of(options, corner));
    }
    scene.fillers = place_fillers(ldi, lens, fillers, samples, scene.colours);
    if (options.point) paint(scene.fillers.colours, scene.colours.sets, ldi.alpha());
    optics.bend(scene.fillers.samples);
    progress.may_end();
    scene.facets = place_facets(find_facets(ldi, lens, double(optics.widest())), ldi.samples(),
                                {samples.x, samples.y, samples.hiding_coc(), samples.key, samples.source});
    scene.solids = place_solids(ldi, lens, samples);
    optics.bend(scene.solids);
    return scene;
}

} // namespace sparselens
