#include "dof/lens/lens_gather.h"

#include "base/parallel.h"
#include "deep/flatten.h"
#include "dof/device/tile_device.h"
#include "dof/lens/accumulator.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/highlight_tile.h"
#include "dof/lens/tile_plan.h"
#include "dof/lens/visibility.h"
#include "dof/tuning.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>

namespace sparselens {

// Gathers one tile of the lens picture. Every lens point sees its own picture of the samples (visibility.h); the tile
// is the mean over the lens points (accumulator.h).

// Calls done(picture) with the result.
void gather_tile(const GatherScene &scene, const TileTask &tile,
                 const std::function<void(const TilePicture &)> &done);

namespace {

// Calls visit(x, y) for the pixels of a part of the tile at `corner` (relative to the window) that lie in the window.
template <typename Visit>
void for_each_pixel(const Imath::V2i &corner, const Imath::Box2i &part, const Windows &windows,
                    const Visit &visit) {
    for (int y = part.min.y; y <= part.max.y && corner.y + y < windows.height(); ++y)
        for (int x = part.min.x; x <= part.max.x && corner.x + x < windows.width(); ++x) visit(x, y);
}

// Ids cannot be averaged: each pixel keeps the id of its front sample.
std::vector<std::size_t> averaged_channels(const Image &image) {
    std::vector<std::size_t> averaged;
    for (std::size_t k = 0; k < image.channels.size(); ++k)
        if (!holds_ids(image.channels[k])) averaged.push_back(k);
    return averaged;
}

// Footprints of all that casts shadows in a scene.
struct SceneFootprints {
    BlockFootprints samples, solids, hiding;
    SceneFootprints(const GatherScene &scene, const GatherScene &of_highlights)
        : samples(*scene.ldi, scene.samples, links_of(scene, of_highlights)),
          solids(*scene.ldi, scene.solids), hiding(*scene.ldi, scene.fillers.hiding) {}
    static std::optional<Links> links_of(const GatherScene &scene, const GatherScene &of_highlights) {
        if (of_highlights.highlights.sample.empty()) return {}; // nothing is shadowed
        return Links(*scene.ldi, scene.lens);
    }
    CasterSets casters(const GatherScene &scene, float across = 1, const Imath::V2f &corner = {0, 0}) const {
        return {{scene.samples, samples, across, corner},
                {scene.solids, solids, across, corner},
                {scene.fillers.hiding, hiding, across, corner}};
    }
};

// The picture that the tiles of a plan make.
struct Gathering {
    const GatherScene &scene;
    const LensGatherOptions &options;
    Image &out;
    TilePlan plan{scene, options, out.windows};
    LensTiles chosen = plan.tiles();
    Darkening darkening{scene.optics->cat_eye, *scene.ldi, out.windows};
    std::map<const GatherScene *, SceneFootprints> footprints = footprints_of_all();
    tbb::enumerable_thread_specific<HighlightTile> lamps{
        [this] { return HighlightTile(scene, footprints.at(&scene).casters(scene)); }};
    std::vector<std::size_t> gathered = averaged_channels(out);

    std::map<const GatherScene *, SceneFootprints> footprints_of_all() const {
        std::map<const GatherScene *, SceneFootprints> all;
        for (const GatherScene *one : plan.scenes()) all.try_emplace(one, *one, scene);
        return all;
    }
    // The casters of shadows on lamps far behind them.
    std::optional<CoarseCasters> coarse_casters(const PlannedTile &tile) const {
        if (!tile.caster_scene) return {};
        const int across = tile.caster_cells;
        const float far = tile.cells || options.quality == Quality::draft
                              ? GatherTuning::shadow_far_cells
                              : GatherTuning::shadow_farther_cells;
        const Imath::V2f corner(tile.caster_scene->optics->corner * across - scene.optics->corner);
        return CoarseCasters{
            footprints.at(tile.caster_scene).casters(*tile.caster_scene, float(across), corner), far};
    }
    // The pixels of a tile in the picture, EXR coordinates.
    Imath::Box2i pixels_of(const PlannedTile &tile) const {
        const Imath::Box2i &all = out.windows.data;
        const Imath::V2i last = tile.first + tile.part.max;
        return {tile.first + tile.part.min, {std::min(last.x, all.max.x), std::min(last.y, all.max.y)}};
    }

    // Sets the pixels of a tile to what is gathered, plus what highlights spread there.
    void finish(const PlannedTile &tile, const TilePicture &made) {
        if (!tile.cells) return set_pixels(tile, made);
        const PixelsOfCells pixels =
            interpolated(made, *tile.cells, options.keeps_sums ? CellRange::open : CellRange::limited);
        set_pixels(tile, pixels.picture());
    }
    void set_pixels(const PlannedTile &tile, const TilePicture &picture) {
        chosen.lens_points[tile.tile] = int(tile.lens.size());
        HighlightTile &lit = lamps.local();
        const std::optional<CoarseCasters> coarse = coarse_casters(tile);
        lit.spread(tile.first - scene.optics->corner, tile.blocks.samples, coarse ? &*coarse : nullptr);
        for_each_pixel(tile.first - out.windows.data.min, tile.part, out.windows, [&](int x, int y) {
            const auto pixel = std::size_t(y * lens_tile_size + x);
            // If the few lens points of a pixel all miss, it stays sharp, which is better than black.
            if (!picture.is_known(pixel) && lit.dark(x, y) && !options.point) return;
            const Imath::V2i at = tile.first + Imath::V2i(x, y);
            for (const std::size_t k : gathered)
                out.at(k, at.x, at.y) =
                    darkening.left(k, at.x, at.y) * picture.value(pixel, k) + lit.value(x, y, k);
        });
    }
};

// Gathers tiles of one scene on the device, and marks the numbers of those that it gathered in `done`.
void gather_on(TileDevice &device, const GatherScene &scene, std::span<const PlannedTile *const> tiles,
               Gathering &from, std::vector<char> &done) {
    std::vector<TileTask> tasks;
    for (const PlannedTile *tile : tiles) tasks.push_back(tile->task());
    device.gather(scene, tasks, [&](std::size_t n, const TilePicture &picture) {
        from.finish(*tiles[n], picture);
        done[tiles[n]->number] = true;
    });
}

void gather_on(TileDevice &device, Gathering &from, std::vector<char> &done) {
    std::vector<std::optional<PlannedTile>> tiles(from.plan.count());
    parallel_for(tiles.size(), [&](std::size_t t) { tiles[t] = from.plan.tile(t); });
    std::map<int, std::vector<const PlannedTile *>> by_cells;
    for (const auto &tile : tiles)
        if (tile) by_cells[tile->cells ? tile->cells->across : 1].push_back(&*tile);
    for (const auto &[across, some] : by_cells) gather_on(device, *some.front()->scene, some, from, done);
}

Image gather_once(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                  const LensGatherOptions &options, double coc, Progress &progress) {
    Image out = in_focus_everywhere(ldi, window, options);
    const GatherScene scene = prepare(ldi, lens, window, options, coc, progress);
    const Timed gathering(progress, "gather");
    gather_tiles(scene, options, progress, out);
    return out;
}

} // namespace

Image in_focus_everywhere(const Ldi &ldi, const Imath::Box2i &window, const LensGatherOptions &options) {
    return crop(options.holdout ? flatten_held_out(ldi, *options.holdout) : flatten(ldi), window);
}

void gather_tiles(const GatherScene &scene, const LensGatherOptions &options, Progress &progress,
                  Image &picture) {
    Gathering from{scene, options, picture};
    from.darkening.darken(picture);
    progress.start("gathering", from.plan.count());
    std::vector<char> done(from.plan.count(), false);
    if (options.device) gather_on(*options.device, from, done);
    const std::vector<std::size_t> order = from.plan.in_order();
    std::atomic<std::size_t> next = 0;
    parallel_for(order.size(), [&](std::size_t i) {
        progress.advance();
        // A watcher is shown the tiles in this order. Without one the threads begin far apart, because adjacent tiles
        // would wait for each other: what may shadow their lamps is found once.
        const std::size_t t = order[options.watch ? next++ : i];
        const std::optional<PlannedTile> tile = done[t] ? std::nullopt : from.plan.tile(t);
        if (!tile) return;
        gather_tile(*tile->scene, tile->task(), [&](const TilePicture &made) { from.finish(*tile, made); });
        if (options.watch) options.watch->made(picture, from.pixels_of(*tile));
    });
    if (options.chosen) *options.chosen = std::move(from.chosen);
}

Image lens_gather(const Ldi &ldi, const ThinLens &given, const Imath::Box2i &window,
                  const LensGatherOptions &asked, Progress &progress) {
    ThinLens lens = given;
    LensGatherOptions options = asked;
    // Only breathing then has an effect, and it needs a finite focus distance. Everything is sharp, and still ordered
    // by depth.
    if (lens.radius == 0) {
        lens.radius = GatherTuning::sharp_px * lens.focus / lens.focal_px;
        options.looks.cat_eye = 0; // there is nothing to cut
    }
    if (options.lamps) {
        find_lamps(ldi, lens, window, options, *options.lamps);
        return Image({ldi.windows.display, window, ldi.windows.pixel_aspect}, ldi.channels);
    }
    Image out = gather_once(ldi, lens, window, options, 0, progress);
    const std::vector<ColourSet> sets = colour_sets(ldi, ldi.channels.size());
    const std::array<double, 3> &cocs = options.looks.chromatic_coc;
    options.watch = nullptr; // some colours of the pictures below are not the final ones
    for (std::size_t colour = 0; colour < 3; ++colour) {
        if (cocs[colour] == 0) continue;
        const Image other = gather_once(ldi, lens, window, options, cocs[colour], progress);
        for (std::size_t k = 0; k < sets.size(); ++k)
            if (sets[k] == std::array{red, green, blue}[colour])
                std::ranges::copy(other.plane(k), out.plane(k).begin());
    }
    return out;
}

namespace {

// Whether any sample of some blocks may lie in front of focus.
bool reaches_in_front(const BlockedSamples &samples, std::span<const std::uint32_t> blocks) {
    return std::ranges::any_of(blocks, [&](std::uint32_t b) {
        return samples.blocks[b].begin != samples.blocks[b].end && samples.blocks[b].coc_min < 0;
    });
}

} // namespace

void gather_tile(const GatherScene &scene, const TileTask &tile,
                 const std::function<void(const TilePicture &)> &done) {
    const bool rims = std::ranges::any_of(tile.lens, &LensSample::has_rims);
    const bool two_sided = rims && (reaches_in_front(scene.samples, tile.samples) ||
                                    reaches_in_front(scene.fillers.samples, tile.fillers));
    VisibilityPass visibility(scene, tile);
    Accumulator sums(scene, visibility.samples(), tile.origin, two_sided);
    for (const LensSample &point : tile.lens) sums.add(visibility.through(point), point);
    done(sums.picture());
}

} // namespace sparselens
