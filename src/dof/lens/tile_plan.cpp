#include "dof/lens/tile_plan.h"

#include "base/parallel.h"
#include "dof/tuning.h"
#include "shutter/shutter_mean.h"

#include <algorithm>
#include <numeric>

namespace sparselens {

namespace {

// Adjacent sub-pixels already look from different positions. Within each, looking from half as far from its middle is
// better than from all of it: by .5 dB on fence and grass at normal quality (at final .0).
void look_from_the_middle(std::vector<LensSample> &points) {
    for (LensSample &point : points) point.pixel_x /= 2, point.pixel_y /= 2;
}

} // namespace

const std::vector<LensSample> &LensSets::for_coc(float largest, std::size_t doubled) {
    if (options_.lens_samples > 0 || options_.point) largest = 0, doubled = 0;
    const std::size_t step = step_for(largest / float(options_.across)), set = doubled * steps + step;
    std::call_once(made_[set], [&] {
        sets_[set] =
            options_.point ? std::vector{through(*options_.point)} : of_share(points_of(step) << doubled);
        if (options_.across > 1) look_from_the_middle(sets_[set]);
    });
    return sets_[set];
}

std::vector<LensSample> LensSets::of_share(std::size_t points) const {
    const auto moments =
        std::size_t(options_.share.moments); // each takes as many, so that all points count alike
    const std::size_t all = pieces_of(points, moments) * moments;
    return shared_points(lens_samples(aperture_, all, pixel_aspect_), options_.share);
}

LensSample LensSets::through(const Imath::V2d &point) const {
    return {float(point.x), float(-point.y * pixel_aspect_), 0, 0, 1};
}

std::size_t LensSets::step_for(float coc) {
    return std::size_t(
        std::find_if(largest_coc.begin(), largest_coc.end() - 1, [&](float most) { return coc <= most; }) -
        largest_coc.begin());
}

std::size_t LensSets::points_of(std::size_t step) const {
    if (options_.lens_samples > 0) return std::size_t(options_.lens_samples);
    return options_.across == 1 ? of_pixel(step) : of_pixel(step) * 3 / 4;
}

std::size_t LensSets::of_pixel(std::size_t step) const {
    switch (options_.quality) {
    case Quality::draft: return normal_points[step] / 3;
    case Quality::final: return final_points[step];
    case Quality::normal: break;
    }
    return normal_points[step];
}

namespace {

LensTiles tiles_of(const Windows &windows) {
    LensTiles tiles{lens_tile_size,
                    pieces_of(windows.width(), lens_tile_size),
                    pieces_of(windows.height(), lens_tile_size),
                    {}};
    tiles.lens_points.resize(std::size_t(tiles.columns) * std::size_t(tiles.rows), 0);
    return tiles;
}

// The same points in the middle of the lens. Where all samples are blurred by more than the picture is wide, points
// farther out see past it; if too few see anything, a wider lens blurs less. Points that count by where they lie stay.
std::vector<LensSample> narrowed(std::span<const LensSample> points, float share) {
    std::vector<LensSample> moved(points.begin(), points.end());
    for (LensSample &point : moved)
        if (point.counts_alike()) point.x *= share, point.y *= share;
    return moved;
}

constexpr int caster_cells = cell_sizes.back();

// Whether tiles may be gathered in cells: not if one lens point or a number of points is asked for, not with a holdout,
// which has pixels of its own, and not if the field skews.
bool has_cells(const LensGatherOptions &options, const Optics &optics) {
    return !options.point && options.lens_samples == 0 && !options.holdout && !optics.field.skews();
}

} // namespace

TileTask PlannedTile::task() const {
    const TileBlocks &from = cells ? cell_blocks : blocks;
    const Imath::V2i origin = (cells ? cells->first : first) - scene->optics->corner;
    return {origin,
            from.samples,
            from.facets,
            from.fillers,
            lens,
            from.solids,
            cells ? cells->count() : lens_tile_size};
}

TilePlan::Level::Level(const GatherScene &full, int cells)
    : across(cells), coarse(cells > 1 ? std::optional(coarse_scene(full, cells)) : std::nullopt),
      scene(coarse ? *coarse : full) {}

TilePlan::TilePlan(const GatherScene &scene, const LensGatherOptions &options, const Windows &picture)
    : scene_(scene), options_(options), picture_(picture), tiles_(tiles_of(picture)),
      sets_(options, optics_.aperture, scene.pixel_aspect()) {
    levels_.emplace_back(scene, 1);
    for (const int cells : cells_asked_for()) levels_.emplace_back(scene, cells);
    if (!has_wide_lamps()) return;
    if (levels_.back().across != caster_cells) levels_.emplace_back(scene, caster_cells);
    casters_ = &levels_.back();
}

std::size_t TilePlan::count() const { return tiles_.lens_points.size() * std::size_t(parts_ * parts_); }

std::vector<const GatherScene *> TilePlan::scenes() const {
    std::vector<const GatherScene *> scenes;
    for (const Level &level : levels_) scenes.push_back(&level.scene);
    return scenes;
}

std::vector<std::size_t> TilePlan::in_order() const {
    std::vector<std::size_t> order(count());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (!options_.watch) return order;
    const auto distance = [this](std::size_t number) {
        const Imath::V2i middle = place_of(number).first + Imath::V2i(lens_tile_size / 2);
        return (Imath::V2d(middle) - Imath::V2d(options_.watch->from)).length2();
    };
    std::ranges::stable_sort(order, {}, distance);
    return order;
}

std::optional<PlannedTile> TilePlan::tile(std::size_t number) {
    PlannedTile tile = place_of(number);
    const std::optional<Blur> blur = blur_of(tile);
    if (!blur) return {};
    gather_from(*std::ranges::find(levels_, blur->cells, &Level::across), *blur, tile);
    return tile;
}

PlannedTile TilePlan::place_of(std::size_t number) const {
    const std::size_t t = number / std::size_t(parts_ * parts_);
    const int n = int(number % std::size_t(parts_ * parts_)), part_size = lens_tile_size / parts_;
    const Imath::V2i part(n % parts_ * part_size, n / parts_ * part_size);
    const Imath::V2i corner(int(t) % tiles_.columns, int(t) / tiles_.columns);
    return {number, t, {part, part + Imath::V2i(part_size - 1)}, picture_.data.min + corner * lens_tile_size};
}

bool TilePlan::moved_light_reaches(const PlannedTile &tile) const {
    bool any = false;
    for_each_moved(scene_, tile.first - optics_.corner, [&](std::span<const std::uint32_t>) { any = true; });
    return any;
}

// Also finds the blocks of the tile. Returns nothing if the tile is in focus or not asked for.
std::optional<TilePlan::Blur> TilePlan::blur_of(PlannedTile &tile) const {
    const Imath::Box2i pixels(tile.first, tile.first + Imath::V2i(lens_tile_size - 1));
    if (options_.region && !options_.region->intersects(pixels)) return {};
    const SceneBlocks &blocks = levels_.front().blocks;
    const Imath::V2i first = tile.first + tile.part.min;
    const int size = lens_tile_size / parts_;
    const Imath::V2d gradient = optics_.coc_gradient(first, size);
    const float steepest = float(stretch(gradient, gradient.normalized() * double(blocks.extent())));
    const double displaced = optics_.displaced(first, size) * double(steepest);
    const int beside = int(std::ceil(displaced));
    const ReachingCocs cocs = blocks.find(tile.first - optics_.corner - Imath::V2i(beside),
                                          lens_tile_size + 2 * beside, steepest, tile.blocks);
    const float largest = cocs.largest * optics_.widest() + float(displaced);
    if (largest < GatherTuning::in_focus_px && !optics_.moves() && !moved_light_reaches(tile)) return {};
    // The edge of a transparent background would be as coarse as the cells.
    const bool cells = has_cells(options_, optics_) && !cocs.with_background;
    return Blur{largest, cocs.least, steepest,
                cells ? cell_size_for(cocs.least * optics_.narrowest(), options_.quality) : 1};
}

std::vector<int> TilePlan::cells_asked_for() const {
    if (!has_cells(options_, optics_)) return {};
    std::vector<int> asked(count(), 1);
    parallel_for(asked.size(), [&](std::size_t number) {
        PlannedTile tile = place_of(number);
        if (const std::optional<Blur> blur = blur_of(tile)) asked[number] = blur->cells;
    });
    std::vector<int> sizes;
    for (const int across : cell_sizes)
        if (std::ranges::find(asked, across) != asked.end()) sizes.push_back(across);
    return sizes;
}

// Whether the shadows in the discs of wide lamps would cost more than a coarse scene, which shortens them.
bool TilePlan::has_wide_lamps() const {
    if (options_.quality == Quality::final || !has_cells(options_, optics_)) return false;
    constexpr float least = GatherTuning::normal_cells * float(caster_cells);
    double shadowed = 0; // pixels
    for (const std::uint32_t i : scene_.highlights.sample)
        if (const float coc = std::abs(scene_.samples.coc[i]); coc >= least) shadowed += double(coc * coc);
    return shadowed > GatherTuning::coarse_casters_pay * double(scene_.samples.count());
}

void TilePlan::gather_from(const Level &level, const Blur &blur, PlannedTile &tile) {
    tile.scene = &level.scene;
    Imath::V2i first = tile.first + tile.part.min;
    int size = lens_tile_size / parts_;
    if (const Level *coarse = level.across > 1 ? &level : casters_) {
        const TileCells cells = cells_of_tile(tile.first, coarse->across);
        coarse->blocks.find(cells.first - coarse->scene.optics->corner, cells.count(), blur.stretched,
                            tile.cell_blocks);
        tile.caster_scene = &coarse->scene;
        tile.caster_cells = coarse->across;
        if (level.across > 1) {
            tile.cells = cells;
            first = cells.first;
            size = cells.count();
        }
    }
    tile.lens = sets_.for_coc(blur.largest, optics_.doubled(tile.first, lens_tile_size));
    const int across = std::max(picture_.display_width(), picture_.display_height());
    if (blur.least > float(across) && !options_.point)
        tile.lens = tile.bent = narrowed(tile.lens, float(across) / blur.least);
    if (!optics_.field.flat()) tile.lens = tile.bent = level.scene.optics->bent(tile.lens, first, size);
}

namespace {

constexpr std::uint32_t blocks_in_run = 8; // as wide as a tile

struct Box {
    float left, right, top, bottom;

    // Returns how far bounds [x_min, x_max] x [y_min, y_max] must move along an axis to reach the box. 0 or less: they
    // touch it already.
    template <typename Bounds>
    float distance(const Bounds &b) const {
        return std::max({left - b.x_max, b.x_min - right, top - b.y_max, b.y_min - bottom});
    }
};

} // namespace

BlockFinder::BlockFinder(const BlockedSamples &samples, const Aperture &aperture, double pixel_aspect)
    : samples_(samples),
      extent_(float(std::max(aperture.half_extent().x, aperture.half_extent().y * pixel_aspect))) {
    const auto columns = std::uint32_t(samples.columns), all = std::uint32_t(samples.blocks.size());
    constexpr float most = std::numeric_limits<float>::max();
    for (std::uint32_t begin = 0, end = 0; begin < all; begin = end) {
        end = std::min(begin + blocks_in_run, begin / columns * columns + columns);
        Run run{begin, end, most, -most, most, -most, 0};
        for (std::uint32_t b = begin; b < end; ++b) {
            const SampleBlock &block = samples.blocks[b];
            if (block.begin == block.end) continue;
            run.x_min = std::min(run.x_min, block.x_min);
            run.x_max = std::max(run.x_max, block.x_max);
            run.y_min = std::min(run.y_min, block.y_min);
            run.y_max = std::max(run.y_max, block.y_max);
            run.reach = std::max(run.reach, reach_of(block));
        }
        if (run.x_min <= run.x_max) runs_.push_back(run);
    }
}

ReachingCocs BlockFinder::find(const Imath::V2i &origin, int size, float stretched,
                               std::vector<std::uint32_t> &found) const {
    found.clear();
    ReachingCocs cocs;
    float largest = 0, largest_shown = 0;
    bool shows_opaque = false;
    const Box box{float(origin.x - 1), float(origin.x + size + 1), float(origin.y - 1),
                  float(origin.y + size + 1)};
    for (const Run &run : runs_) {
        if (box.distance(run) > run.reach * stretched + 1) continue;
        for (std::uint32_t b = run.begin; b < run.end; ++b) {
            const SampleBlock &block = samples_.blocks[b];
            const float distance = box.distance(block);
            if (block.begin == block.end || distance > reach_of(block) * stretched + 1) continue;
            found.push_back(b);
            largest = std::max(largest, largest_coc_of(block));
            largest_shown = std::max(largest_shown, block.coc_shown);
            // samples with a smaller CoC do not reach the box
            cocs.least =
                std::min(cocs.least, std::max(block.coc_least, (distance - 1) / (extent_ * stretched)));
            cocs.with_background = cocs.with_background || block.has_background;
            shows_opaque = shows_opaque || block.shows_opaque;
        }
    }
    cocs.largest = shows_opaque ? largest : largest_shown;
    return cocs;
}

float BlockFinder::reach_of(const SampleBlock &block) const {
    return block.begin == block.end ? 0 : largest_coc_of(block) * extent_;
}

SceneBlocks::SceneBlocks(const GatherScene &scene)
    : scene_(scene), samples_(scene.samples, scene.optics->aperture, scene.pixel_aspect()),
      fillers_(scene.fillers.samples, scene.optics->aperture, scene.pixel_aspect()),
      solids_(scene.solids, scene.optics->aperture, scene.pixel_aspect()) {}

ReachingCocs SceneBlocks::find(const Imath::V2i &origin, int size, float stretched, TileBlocks &found) const {
    ReachingCocs cocs = samples_.find(origin, size, stretched, found.samples);
    for (const auto &[finder, blocks] :
         {std::pair(&fillers_, &found.fillers), std::pair(&solids_, &found.solids)})
        cocs.least = std::min(cocs.least, finder->find(origin, size, stretched, *blocks).least);
    find_blocks(scene_.facets, origin, size, stretched * extent(), found.facets);
    return cocs;
}

} // namespace sparselens
