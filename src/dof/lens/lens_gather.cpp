#include "dof/lens/lens_gather.h"

#include "base/parallel.h"
#include "deep/flatten.h"
#include "dof/device/tile_device.h"
#include "dof/lens/block_finder.h"
#include "dof/lens/gather_scene.h"
#include "dof/lens/gather_tile.h"
#include "dof/lens/highlight_tile.h"
#include "dof/lens/lens_sets.h"
#include "dof/lens/lens_tiles.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>

namespace sparselens {

namespace {

constexpr double sharp_coc = 1e-3; // pixels: of infinity, seen by a lens of radius 0

// visit(x, y) for the pixels of a part of the tile at `corner` (relative to the window) that lie in the window.
template <typename Visit>
void for_each_pixel(const Imath::V2i &corner, const Imath::Box2i &part, const Windows &windows,
                    const Visit &visit) {
    for (int y = part.min.y; y <= part.max.y && corner.y + y < windows.height(); ++y)
        for (int x = part.min.x; x <= part.max.x && corner.x + x < windows.width(); ++x) visit(x, y);
}

// None has lens points yet.
LensTiles tiles_of(const Windows &windows) {
    LensTiles tiles{lens_tile_size,
                    (windows.width() + lens_tile_size - 1) / lens_tile_size,
                    (windows.height() + lens_tile_size - 1) / lens_tile_size,
                    {}};
    tiles.lens_points.resize(std::size_t(tiles.columns) * std::size_t(tiles.rows), 0);
    return tiles;
}

// Ids cannot be averaged: each pixel keeps its front sample's.
std::vector<std::size_t> averaged_channels(const Image &image) {
    std::vector<std::size_t> averaged;
    for (std::size_t k = 0; k < image.channels.size(); ++k)
        if (!holds_ids(image.channels[k])) averaged.push_back(k);
    return averaged;
}

// A tile that is out of focus, and what it is gathered from.
struct PreparedTile {
    std::size_t number, tile;
    Imath::Box2i part; // of the tile, that is made
    Imath::V2i first;  // pixel, EXR coordinates
    Imath::V2i origin; // the same, relative to the data window's corner
    std::vector<std::uint32_t> samples = {}, facets = {}, fillers = {}, solids = {}; // blocks of them
    std::span<const LensSample> lens = {};
    std::vector<LensSample> bent = {};

    TileTask task() const { return {origin, samples, facets, fillers, lens, solids}; }
};

// The scene, and the picture that its tiles make.
struct Gathering {
    const GatherScene &scene;
    const LensGatherOptions &options;
    Image &out;
    LensTiles chosen = tiles_of(out.windows);
    const Optics &optics = *scene.optics;
    Darkening darkening{optics.cat_eye, *scene.ldi, out.windows};
    BlockFootprints footprints{*scene.ldi, scene.samples}, solid_footprints{*scene.ldi, scene.solids};
    tbb::enumerable_thread_specific<HighlightTile> lamps{
        [this] { return HighlightTile(scene, footprints, solid_footprints); }};
    BlockFinder finder{scene.samples, optics.aperture, scene.pixel_aspect},
        filler_finder{scene.fillers.samples, optics.aperture, scene.pixel_aspect},
        solid_finder{scene.solids, optics.aperture, scene.pixel_aspect};
    LensSets sets{options, optics.aperture, scene.pixel_aspect};
    std::vector<std::size_t> gathered = averaged_channels(out);

    // Across and down: where discs are skewed, each part of a tile has lens points of its own.
    const int parts = optics.field.skews() ? 2 : 1;

    std::size_t tiles() const { return chosen.lens_points.size() * std::size_t(parts * parts); }

    // Their numbers, from the place outwards that is looked at.
    std::vector<std::size_t> in_order() const {
        std::vector<std::size_t> order(tiles());
        std::iota(order.begin(), order.end(), std::size_t{0});
        if (!options.watch) return order;
        const auto distance = [this](std::size_t number) {
            const int t = int(number / std::size_t(parts * parts)), half = lens_tile_size / 2;
            const Imath::V2i corner(t % chosen.columns, t / chosen.columns);
            const Imath::V2i middle = out.windows.data.min + corner * lens_tile_size + Imath::V2i(half);
            return (Imath::V2d(middle) - Imath::V2d(options.watch->from)).length2();
        };
        std::ranges::stable_sort(order, {}, distance);
        return order;
    }
    // EXR coordinates.
    Imath::Box2i pixels_of(const PreparedTile &tile) const {
        const Imath::Box2i &all = out.windows.data;
        const Imath::V2i last = tile.first + tile.part.max;
        return {tile.first + tile.part.min, {std::min(last.x, all.max.x), std::min(last.y, all.max.y)}};
    }

    // None where nothing is out of focus: the flattened LDI is there already.
    std::optional<PreparedTile> prepare(std::size_t number) {
        const std::size_t t = number / std::size_t(parts * parts);
        const int n = int(number % std::size_t(parts * parts)), part_size = lens_tile_size / parts;
        const Imath::V2i part(n % parts * part_size, n / parts * part_size);
        const Imath::V2i corner(int(t) % chosen.columns, int(t) / chosen.columns);
        const Imath::V2i first = out.windows.data.min + corner * lens_tile_size;
        const Imath::Box2i pixels(first, first + Imath::V2i(lens_tile_size - 1));
        if (options.region && !options.region->intersects(pixels)) return {};
        PreparedTile tile{number, t, {part, part + Imath::V2i(part_size - 1)}, first, first - optics.corner};
        const Imath::V2d gradient = optics.coc_gradient(first + part, part_size);
        const float steepest = float(stretch(gradient, gradient.normalized() * double(finder.extent())));
        const double displaced = optics.displaced(first + part, part_size) * double(steepest);
        const int beside = int(std::ceil(displaced)), size = lens_tile_size + 2 * beside;
        const Imath::V2i origin = tile.origin - Imath::V2i(beside);
        const float largest =
            finder.find(origin, size, steepest, tile.samples) * optics.widest() + float(displaced);
        if (largest < in_focus && !optics.moves()) return {};
        const std::vector<LensSample> &points = sets.for_coc(largest, optics.doubled(first, lens_tile_size));
        filler_finder.find(origin, size, steepest, tile.fillers);
        solid_finder.find(origin, size, steepest, tile.solids);
        find_blocks(scene.facets, origin, size, steepest * finder.extent(), tile.facets);
        tile.lens = points;
        if (!optics.field.flat()) tile.lens = tile.bent = optics.bent(points, first + part, part_size);
        return tile;
    }

    // Sets its pixels to what is gathered, and to what highlights spread there.
    void finish(const PreparedTile &tile, const TilePicture &picture) {
        chosen.lens_points[tile.tile] = int(tile.lens.size());
        HighlightTile &lit = lamps.local();
        lit.spread(tile.origin, tile.samples, tile.solids);
        for_each_pixel(tile.first - out.windows.data.min, tile.part, out.windows, [&](int x, int y) {
            const auto pixel = std::size_t(y * lens_tile_size + x);
            // A few lens points may all miss: better sharp than black.
            if (!picture.is_known(pixel) && lit.dark(x, y) && !options.point) return;
            const Imath::V2i at = tile.first + Imath::V2i(x, y);
            for (const std::size_t k : gathered)
                out.at(k, at.x, at.y) =
                    darkening.left(k, at.x, at.y) * picture.value(pixel, k) + lit.value(x, y, k);
        });
    }
};

// The numbers of the tiles that the device gathered are marked in `done`.
void gather_on(TileDevice &device, Gathering &from, std::vector<char> &done) {
    std::vector<std::optional<PreparedTile>> tiles(from.tiles());
    parallel_for(tiles.size(), [&](std::size_t t) { tiles[t] = from.prepare(t); });
    std::erase(tiles, std::nullopt);
    if (tiles.empty()) return;
    std::vector<TileTask> tasks;
    for (const auto &tile : tiles) tasks.push_back(tile->task());
    device.gather(from.scene, tasks, [&](std::size_t n, const TilePicture &picture) {
        from.finish(*tiles[n], picture);
        done[tiles[n]->number] = true;
    });
}

Image gather_once(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                  const LensGatherOptions &options, double coc, Progress &progress) {
    Image out = in_focus_everywhere(ldi, window, options);
    gather_tiles(prepare(ldi, lens, window, options, coc, progress), options, progress, out);
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
    progress.start("gathering", from.tiles());
    std::vector<char> done(from.tiles(), false);
    if (options.device) gather_on(*options.device, from, done);
    const std::vector<std::size_t> order = from.in_order();
    std::atomic<std::size_t> next = 0; // whichever thread: one after the other
    parallel_for(from.tiles(), [&](std::size_t) {
        progress.advance();
        const std::size_t t = order[next++];
        const std::optional<PreparedTile> tile = done[t] ? std::nullopt : from.prepare(t);
        if (!tile) return;
        gather_tile(scene, tile->task(), [&](const TilePicture &made) { from.finish(*tile, made); });
        if (options.watch) options.watch->made(picture, from.pixels_of(*tile));
    });
    if (options.chosen) *options.chosen = std::move(from.chosen);
}

Image lens_gather(const Ldi &ldi, const ThinLens &given, const Imath::Box2i &window,
                  const LensGatherOptions &asked, Progress &progress) {
    ThinLens lens = given;
    LensGatherOptions options = asked;
    // Only breathing shows then, which asks for a finite focus distance: all is sharp, and still ordered by depth.
    if (lens.radius == 0) {
        lens.radius = sharp_coc * lens.focus / lens.focal_px;
        options.looks.cat_eye = 0; // there is nothing to cut
    }
    Image out = gather_once(ldi, lens, window, options, 0, progress);
    const std::vector<ColourSet> sets = colour_sets(ldi, ldi.channels.size());
    const std::array<double, 3> &cocs = options.looks.chromatic_coc;
    options.watch = nullptr; // of these, some colours are not those of the picture
    for (std::size_t colour = 0; colour < 3; ++colour) {
        if (cocs[colour] == 0) continue;
        const Image other = gather_once(ldi, lens, window, options, cocs[colour], progress);
        for (std::size_t k = 0; k < sets.size(); ++k)
            if (sets[k] == std::array{red, green, blue}[colour])
                std::ranges::copy(other.plane(k), out.plane(k).begin());
    }
    return out;
}

} // namespace sparselens
