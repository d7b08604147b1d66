#include "dof/lens/gather_scene.h"

#include "base/parallel.h"
#include "base/subpixels.h"
#include "deep/proxy.h"
#include "dof/facets/facets.h"
#include "dof/lens/cells.h"
#include "dof/lens/sharpen.h"
#include "dof/tuning.h"
#include "lens/thin_lens.h"

#include <functional>
#include <optional>
#include <utility>

namespace sparselens {

namespace {

bool is_sharp(const BlockedSamples &samples, const Optics &optics) {
    return !optics.moves() && !optics.field.skews() &&
           std::ranges::all_of(samples.blocks, [&](const SampleBlock &block) {
               return block.begin == block.end ||
                      largest_coc_of(block) * optics.widest() < GatherTuning::in_focus_px;
           });
}

std::optional<PositionBox> seen_of(const LensGatherOptions &options, const Grid &grid) {
    if (!options.seen) return {};
    return PositionBox{grid.position(options.seen->min), grid.position(options.seen->max)};
}

// Makes the colours half magenta, by their coverage.
void paint(SampleColours &colours, std::span<const ColourSet> sets, std::size_t alpha) {
    for (std::size_t k = 0; k < sets.size(); ++k) {
        if (!is_colour(sets[k])) continue;
        const float mark = (sets[k] & green) != 0 ? 0 : 0.5f;
        for (std::size_t i = 0; i < colours.count; ++i)
            colours.at(k, i) = colours.at(k, i) / 2 + mark * (alpha == npos ? 1 : colours.at(alpha, i));
    }
}

// The scene with its samples, moved by the looks, but without colours.
GatherScene placed(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks, double coc,
                   const KnownPixels &known) {
    const Imath::V2i corner = ldi.windows.data.min;
    GatherScene scene{&ldi,
                      known,
                      lens,
                      std::make_unique<Optics>(ldi, lens, looks, coc),
                      {nullptr, disparity(lens, 1), corner},
                      make_blocks(ldi, lens, known),
                      {},
                      {},
                      {},
                      {}};
    scene.optics->bend(scene.samples);
    return scene;
}

GatherScene placed_for(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                       const LensGatherOptions &options, double coc) {
    return placed(ldi, lens, options.looks, coc, {options.known.value_or(window), options.unseen});
}

void take_highlights(GatherScene &scene, const LensGatherOptions &options) {
    scene.highlights = take_highlights(*scene.ldi, scene.samples, scene.colours,
                                       seen_of(options, scene.ldi->windows.grid()));
}

// Adds everything but the samples to a scene. `treat` changes the colours before fillers take some of them, and tells
// whether there are lamps to hide.
template <typename Treat>
void complete(GatherScene &scene, const Treat &treat, const Progress &progress) {
    const Ldi &ldi = *scene.ldi;
    const Optics &optics = *scene.optics;
    BlockedSamples &samples = scene.samples;
    // Before the colours are made, because this takes memory.
    LargeArray<Filler> fillers = find_fillers(ldi, scene.lens, scene.known);
    progress.may_end();
    scene.colours = make_colours(ldi, samples);
    std::optional<std::span<const std::uint32_t>> highlights;
    if (treat()) highlights = scene.highlights.sample;
    scene.solids = place_solids(ldi, scene.lens, fillers, samples);
    scene.fillers =
        place_fillers(ldi, scene.lens, std::exchange(fillers, {}), samples, scene.colours, highlights);
    for (BlockedSamples *some : {&scene.solids, &scene.fillers.samples, &scene.fillers.hiding})
        optics.bend(*some);
    progress.may_end();
    scene.facets = place_facets(find_facets(ldi, scene.lens, double(optics.widest())), ldi.samples(),
                                {samples.x, samples.y, samples.hiding_coc(), samples.source});
}

// The share of each sample's light that highlights leave; empty: all of it.
std::vector<float> left_by_highlights(const GatherScene &scene) {
    const std::vector<std::uint32_t> &from = scene.highlights.sample;
    if (from.empty()) return {};
    std::vector<float> left(scene.ldi->samples(), 1.0f);
    for (std::size_t n = 0; n < from.size(); ++n)
        left[scene.samples.source[from[n]]] -= scene.highlights.share[n];
    return left;
}

// Scales looks that are counted in pixels. The middle of the small display window may lie elsewhere.
LensLooks smaller(LensLooks looks, const Windows &large, const Windows &small, int across) {
    const auto middle = [](const Windows &windows) {
        return Imath::V2d(windows.display.min + windows.display.max + Imath::V2i(1)) / 2;
    };
    looks.axis = (middle(large) + looks.axis) / double(across) - middle(small);
    return looks;
}

// Marks the cells of `small` with pixels that are not known, or that the large window does not have.
std::vector<char> unseen_cells(const GatherScene &scene, const Windows &small, int across) {
    const Windows &large = scene.ldi->windows;
    std::vector<int> known(small.pixels(), 0);
    for (std::size_t pixel = 0; pixel < large.pixels(); ++pixel) {
        const Imath::V2i at = large.pixel(pixel), cell = reduced({at, at}, across).min;
        known[small.index(cell)] += scene.known.has(large, pixel);
    }
    std::vector<char> unseen(small.pixels());
    std::ranges::transform(known, unseen.begin(), [&](int pixels) { return pixels < across * across; });
    return unseen;
}

} // namespace

void find_lamps(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                const LensGatherOptions &options, std::vector<LampPart> &lamps) {
    GatherScene scene = placed_for(ldi, lens, window, options, 0);
    if (is_sharp(scene.samples, *scene.optics)) return;
    scene.colours = make_colours(ldi, scene.samples);
    take_highlights(scene, options);
    const std::vector<LampPart> found =
        lamp_parts(scene.highlights, scene.samples, light_channels(ldi).brightness, scene.held_out.corner);
    lamps.insert(lamps.end(), found.begin(), found.end());
}

GatherScene prepare(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                    const LensGatherOptions &options, double coc, const Progress &progress) {
    GatherScene scene = placed_for(ldi, lens, window, options, coc);
    scene.held_out.by = options.holdout;
    if (is_sharp(scene.samples, *scene.optics)) return scene;
    progress.may_end();
    const auto treat = [&] {
        if (options.point) return false;
        const SharpenLooks looks{scene.optics->aperture, scene.optics->field, coc, options.seen};
        sharpen_near_focus(ldi, lens, scene.samples, scene.colours, &looks);
        progress.may_end();
        take_highlights(scene, options);
        if (options.paths)
            spread_along(*options.paths, scene.samples, scene.held_out.corner, scene.highlights);
        return !scene.highlights.sample.empty();
    };
    complete(scene, treat, progress);
    if (options.point) paint(scene.fillers.colours, scene.colours.sets, ldi.alpha());
    return scene;
}

GatherScene coarse_scene(const GatherScene &scene, int across) {
    const double tolerance = double(GatherTuning::one_cell) * across;
    const Ldi &large = *scene.ldi;
    const std::vector<float> left = left_by_highlights(scene);
    const auto joined = joined_in_cells(large, Links(large, scene.lens), across, float(tolerance));
    auto small = std::make_unique<Ldi>(proxy(
        large, across, {disparity_scale(scene.lens.radius, scene.lens.focal_px), tolerance, left, joined}));
    // A sample that covers a part of a cell is spread over the cell. With an offset, it would hide its neighbours, and
    // light would be lost.
    small->dx.clear(), small->dy.clear();
    ThinLens lens = scene.lens;
    lens.focal_px /= across;
    const std::vector<char> unseen = unseen_cells(scene, small->windows, across);
    const LensLooks looks = smaller(scene.optics->looks, large.windows, small->windows, across);
    GatherScene coarse =
        placed(*small, lens, looks, scene.optics->coc / across, {small->windows.data, unseen});
    complete(coarse, [&] { return !scene.highlights.sample.empty(); }, {});
    coarse.known.unseen = {};
    for (std::size_t k = 0; k < small->values.size(); ++k)
        if (k != small->alpha()) small->values[k] = {};
    coarse.coarse = std::move(small);
    return coarse;
}

Optics::Optics(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks_, double coc_)
    : looks(looks_), coc(coc_), corner(ldi.windows.data.min), aperture(looks.aperture),
      frame(picture_frame(ldi.windows, looks)), field(looks, lens, frame), cat_eye(aperture, looks, frame) {}

std::size_t Optics::doubled(const Imath::V2i &first, int size) const {
    if (!cat_eye.cuts()) return 0;
    const double left = cat_eye.share(CatEye::Light::evenly, Imath::V2d(first) + Imath::V2d(size / 2));
    return left <= 0.25 ? 2 : left <= 0.5 ? 1 : 0;
}

float Optics::widest() const {
    return float(std::max(aperture.half_extent().x, aperture.half_extent().y * frame.pixel_aspect));
}

void Optics::bend(BlockedSamples &samples) const {
    if (!moves() && coc == 0 && field.flat()) return;
    parallel_for(samples.blocks.size(), [&](std::size_t b) {
        SampleBlock &block = samples.blocks[b];
        for (std::uint32_t i = block.begin; i < block.end; ++i) {
            const Imath::V2d p = Imath::V2d(double(samples.x[i]), double(samples.y[i])) + Imath::V2d(corner);
            const Imath::V2d at = field.shown_at(p) - Imath::V2d(corner);
            const auto bent = [&](float of) { return float(field.bent(double(of) + coc, p)); };
            samples.coc[i] = bent(samples.coc[i]);
            if (!samples.surface_coc.empty()) samples.surface_coc[i] = bent(samples.surface_coc[i]);
            samples.x[i] = float(at.x);
            samples.y[i] = float(at.y);
        }
        bound(block, samples);
    });
}

float Optics::narrowest() const {
    return float(std::min(aperture.half_extent().x, aperture.half_extent().y * frame.pixel_aspect));
}

Imath::V2d Optics::coc_gradient(const Imath::V2i &first, int size) const {
    if (field.flat()) return {0, 0};
    const Imath::V2d middle = Imath::V2d(first) + Imath::V2d(size / 2);
    return field.coc_gradient(frame.magnified(middle, 1 / looks.magnification));
}

Imath::V2d Optics::skew(const Imath::V2d &p) const {
    return field.skew(frame.magnified(p, 1 / looks.magnification));
}

double Optics::displaced(const Imath::V2i &first, int size) const {
    const Imath::V2d most = aperture.half_extent();
    return skew(Imath::V2d(first) + Imath::V2d(size / 2)).length() * std::max(most.x, most.y) *
           std::max(1.0, frame.pixel_aspect);
}

std::vector<LensSample> Optics::bent(std::span<const LensSample> points, const Imath::V2i &first,
                                     int size) const {
    const Imath::V2d gradient = coc_gradient(first, size), s = skew(Imath::V2d(first) + Imath::V2d(size / 2));
    std::vector<LensSample> moved(points.begin(), points.end());
    for (LensSample &p : moved) {
        const Imath::V2d all = skewed(s, {double(p.x), -double(p.y) / frame.pixel_aspect});
        const auto factor = float(stretch(gradient, {double(p.x), double(p.y)}));
        p.x *= factor;
        p.y *= factor;
        p.pixel_x += factor * float(all.x);
        p.pixel_y -= factor * float(all.y * frame.pixel_aspect);
    }
    return moved;
}

Darkening::Darkening(const CatEye &cat_eye, const Ldi &ldi, const Windows &windows)
    : windows_(windows), sets_(colour_sets(ldi, ldi.channels.size())) {
    if (!cat_eye.darkens()) return;
    left_.resize(windows.pixels());
    const Imath::Box2i &window = windows.data;
    parallel_for(std::size_t(windows.height()), [&](std::size_t row) {
        const int y = window.min.y + int(row);
        std::ranges::copy(cat_eye.shares(CatEye::Light::evenly, {{window.min.x, y}, {window.max.x, y}}),
                          &left_[row * std::size_t(windows.width())]);
    });
}

void Darkening::darken(Image &image) const {
    if (left_.empty()) return;
    for (std::size_t k = 0; k < sets_.size(); ++k)
        if (is_colour(sets_[k]))
            std::ranges::transform(image.plane(k), left_, image.plane(k).begin(), std::multiplies());
}

} // namespace sparselens
