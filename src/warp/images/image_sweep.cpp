#include "warp/images/image_sweep.h"

#include "base/numbers.h"
#include "base/subpixels.h"
#include "warp/images/patch_comparison.h"
#include "warp/tuning.h"

#include <array>
#include <cmath>
#include <utility>

namespace sparselens {

namespace {

constexpr std::size_t coarse = WarpTuning::image_coarse_steps;
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

// Returns the median of the depths in a block, which is on the surface that most pixels show; NaN if there is none.
float surface_of(const MatchedView &centre, const Imath::Box2i &block) {
    std::vector<float> depths;
    for (int y = block.min.y; y <= block.max.y; ++y)
        for (int x = block.min.x; x <= block.max.x; ++x)
            if (const float depth = centre.depth(x, y); !std::isnan(depth)) depths.push_back(depth);
    if (depths.empty()) return unknown;
    return median(depths);
}

// The depths that are tried, in equal steps.
struct Depths {
    double first, by;
    std::size_t count;

    explicit Depths(float surface) : first(-WarpTuning::image_behind_camera_px) {
        const double last = 1.5 * double(surface) + WarpTuning::image_behind_camera_px;
        by = std::max(WarpTuning::image_step_px, (last - first) / double(WarpTuning::image_most_steps - 1));
        count = std::size_t((last - first) / by) + 1;
    }
    double at(double k) const { return first + by * k; }
    std::size_t nearest(double depth) const {
        return std::min(std::size_t(std::max((depth - first) / by + 0.5, 0.0)), count - 1);
    }
};

// Returns where the parabola through three values in equal steps is least, relative to the middle one: [-1/2, 1/2].
double least_of_parabola(double before, double middle, double after) {
    const double bend = before - 2 * middle + after;
    return bend > 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

// Returns the step with the least value among every `every`-th step; npos if none is known.
std::size_t least_of(const Curves &curve, std::size_t count, std::size_t pixel, std::size_t every) {
    std::size_t best = npos;
    for (std::size_t k = 0; k < count; k += every)
        if (!std::isnan(curve.at(k, pixel)) && (best == npos || curve.at(k, pixel) < curve.at(best, pixel)))
            best = k;
    return best;
}

// Returns the step of the curve's valley if it has one clear valley. Of the steps that are not coarse, only those
// beside the least are known.
std::optional<double> valley_of(const Curves &curve, std::size_t count, std::size_t pixel, float at_surface) {
    const auto value = [&](std::size_t k) { return curve.at(k, pixel); };
    const std::size_t best = least_of(curve, count, pixel, 1);
    if (best == npos || best < 3 || best + 3 >= count ||
        !(value(best) <= WarpTuning::image_left * at_surface))
        return {};
    constexpr float rounding = 1e-7f;
    const float high = WarpTuning::image_valley * value(best) + rounding;
    if (!(value(best - 3) > high && value(best + 3) > high)) return {};
    for (std::size_t k = coarse; k + coarse < count; k += coarse) {
        const bool beside = k + 4 > best && k < best + 4;
        if (!beside && value(k) <= value(k - coarse) && value(k) <= value(k + coarse) &&
            value(k) < WarpTuning::image_rival * value(best) + rounding)
            return {};
    }
    return double(best) + least_of_parabola(value(best - 1), value(best), value(best + 1));
}

// Marks the steps between coarse ones that valley_of() looks at if `best` is the least coarse step: one and three steps
// from it.
void mark_beside(std::size_t best, std::vector<bool> &marks) {
    for (const std::size_t off : {std::size_t{1}, std::size_t{3}}) {
        if (best >= off) marks[best - off] = true;
        if (best + off < marks.size()) marks[best + off] = true;
    }
}

// Marks the steps that tell whether a guess is right.
void mark_around(std::size_t guess, std::vector<bool> &marks) {
    constexpr std::size_t reach = WarpTuning::image_guess_steps;
    for (std::size_t k = guess - std::min(guess, reach); k <= std::min(guess + reach, marks.size() - 1); ++k)
        marks[k] = true;
}

PatchComparison::Field field_of(const PatchComparison &comparison,
                                const std::function<float(const Imath::V2i &)> &depth_at) {
    PatchComparison::Field depths;
    depths.fill(unknown);
    for (int y = 0; y < comparison.height(); ++y)
        for (int x = 0; x < comparison.width(); ++x)
            depths[PatchComparison::at(x, y)] = depth_at(comparison.corner() + Imath::V2i(x, y));
    return depths;
}

void fill_with_median(PatchComparison::Field &depths) {
    std::vector<float> known;
    for (const float depth : depths)
        if (!std::isnan(depth)) known.push_back(depth);
    if (known.empty()) return;
    const float middle = median(known);
    for (float &depth : depths)
        if (std::isnan(depth)) depth = middle;
}

} // namespace

void ImageSweep::make_room() const {
    // rows of tiles: how far apart a view may show what is searched at one position
    constexpr std::size_t rows = 3;
    std::size_t held = 0, much = 0;
    for (const MatchedView &view : views_) {
        held += view.bytes();
        much += rows * view.bytes_of_row();
    }
    if (held > much)
        for (MatchedView &view : views_) view.forget_unused();
}

bool ImageSweep::has_many_depths(const Imath::Box2i &block) const {
    const float surface = surface_of(views_[0], block);
    return !std::isnan(surface) && Depths(surface).count > WarpTuning::image_many_depths;
}

std::vector<ImageMatch> ImageSweep::search(const Imath::Box2i &block,
                                           const std::optional<std::vector<float>> &guesses) const {
    const MatchedView &centre = views_[0];
    const Grid grid(block);
    std::vector<ImageMatch> matches(grid.size());
    const float surface = surface_of(centre, block);
    if (std::isnan(surface)) return matches;
    PatchComparison comparison(centre, block, surface);
    MeanCurves at_surface(views_, 1, grid.size());
    at_surface.find(0, [&](const MatchedView &view, std::span<float> out) {
        comparison.at_depths(view, comparison.own_depths(), 0, out);
    });
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const Imath::V2i p = grid.pixel(i);
        ImageMatch &match = matches[i];
        match.own_depth = centre.depth(p.x, p.y);
        if (!kernels::is_one_surface(match.own_depth, surface, one_mirror_px)) continue;
        match.at_surface = at_surface.at(0, i);
        match.surface = !std::isnan(match.at_surface);
    }
    const auto worth_it = [](const ImageMatch &m) {
        return m.surface && m.at_surface >= WarpTuning::image_least_difference;
    };
    // true for most edges of texture, once smoothed
    if (std::ranges::none_of(matches, worth_it)) return matches;
    const Depths depths(surface);
    MeanCurves curves(views_, depths.count, grid.size());
    const auto find = [&](std::size_t k) {
        curves.find(k, [&](const MatchedView &view, std::span<float> out) {
            comparison.at_depth(view, depths.at(double(k)), out);
        });
    };
    std::vector<bool> tried(depths.count);
    if (guesses && depths.count > WarpTuning::image_many_depths) {
        for (const float guess : *guesses) mark_around(depths.nearest(double(guess)), tried);
        for (std::size_t k = 0; k < depths.count; ++k)
            if (tried[k]) find(k);
    } else {
        for (std::size_t k = 0; k < depths.count; k += coarse) find(k);
        for (std::size_t i = 0; i < grid.size(); ++i) {
            if (!worth_it(matches[i])) continue;
            const std::size_t best = least_of(curves, depths.count, i, coarse);
            if (best != npos) mark_beside(best, tried);
        }
        for (std::size_t k = 0; k < depths.count; ++k)
            if (tried[k] && k % coarse != 0) find(k);
    }
    for (std::size_t i = 0; i < grid.size(); ++i) {
        ImageMatch &match = matches[i];
        if (!worth_it(match)) continue;
        if (const auto k = valley_of(curves, depths.count, i, match.at_surface)) {
            match.depth = float(depths.at(*k));
            match.found =
                std::abs(match.depth - match.own_depth) >= WarpTuning::image_least_px * float(unit_);
        }
    }
    return matches;
}

std::vector<float> ImageSweep::refined(const Imath::Box2i &block,
                                       const std::function<float(const Imath::V2i &)> &depth_at) const {
    constexpr int side = WarpTuning::image_fine_steps;
    constexpr double by = WarpTuning::image_fine_px;
    const MatchedView &centre = views_[0];
    const Grid grid(block);
    std::vector<float> refined(grid.size());
    for (std::size_t i = 0; i < grid.size(); ++i) refined[i] = depth_at(grid.pixel(i));
    const bool known = std::ranges::any_of(refined, [](float depth) { return !std::isnan(depth); });
    const float surface = known ? surface_of(centre, block) : unknown;
    if (std::isnan(surface)) return std::vector<float>(grid.size(), unknown);
    PatchComparison comparison(centre, block, surface);
    const PatchComparison::Field depths = field_of(comparison, depth_at);
    constexpr std::size_t steps = 2 * side + 1;
    MeanCurves curves(views_, steps, grid.size());
    for (std::size_t k = 0; k < steps; ++k)
        curves.find(k, [&](const MatchedView &view, std::span<float> out) {
            comparison.at_depths(view, depths, by * (double(k) - side), out);
        });
    std::array<float, steps> curve;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        for (std::size_t k = 0; k < steps; ++k) curve[k] = curves.at(k, i);
        const std::size_t best = std::size_t(std::ranges::min_element(curve) - curve.begin());
        const bool inside = best > 0 && best + 1 < steps &&
                            std::ranges::none_of(curve, [](float c) { return std::isnan(c); });
        const double moved = inside ? by * (double(best) - side +
                                            least_of_parabola(curve[best - 1], curve[best], curve[best + 1]))
                                    : 0;
        refined[i] = float(double(refined[i]) + moved);
    }
    return refined;
}

std::vector<float> ImageSweep::differences(const Imath::Box2i &block,
                                           const std::function<float(const Imath::V2i &)> &depth_at) const {
    const std::size_t pixels = Grid(block).size();
    std::vector<float> differences((views_.size() - 1) * pixels, unknown);
    const float surface = surface_of(views_[0], block);
    if (std::isnan(surface)) return differences;
    PatchComparison comparison(views_[0], block, surface);
    PatchComparison::Field depths = field_of(comparison, depth_at);
    fill_with_median(depths);
    for (std::size_t v = 1; v < views_.size(); ++v)
        comparison.at_depths(views_[v], depths, 0, std::span(differences).subspan((v - 1) * pixels, pixels));
    return differences;
}

namespace {

constexpr std::size_t block_pixels = std::size_t(image_block) * image_block;
constexpr std::size_t band_rows = 13; // of blocks: about as high as a tile of the views

// The blocks of a picture of half the size that contain these blocks.
std::vector<std::size_t> halved(const Tiles<> &tiles, const std::vector<std::size_t> &blocks,
                                const Tiles<> &half) {
    std::vector<bool> marks(half.count());
    for (const std::size_t block : blocks) {
        const Grid pixels(reduced(tiles.box(block), 2));
        for (std::size_t n = 0; n < pixels.size(); ++n) marks[half.tile_of(pixels.pixel(n))] = true;
    }
    std::vector<std::size_t> found;
    for (std::size_t n = 0; n < marks.size(); ++n)
        if (marks[n]) found.push_back(n);
    return found;
}

// Returns guesses for the blocks that have many depths; nothing if few blocks have.
std::optional<ImageGuesses> guesses_for(const ImageSweep &sweep, const Imath::Box2i &data,
                                        std::vector<std::size_t> blocks) {
    const Tiles tiles(data, image_block);
    std::erase_if(blocks, [&](std::size_t block) { return !sweep.has_many_depths(tiles.box(block)); });
    const bool few = double(blocks.size()) < WarpTuning::image_many_blocks * double(tiles.count());
    if (few || sweep.views()[0].across() >= WarpTuning::image_smallest) return {};
    std::vector<MatchedView> views;
    views.reserve(sweep.views().size());
    for (const MatchedView &view : sweep.views()) views.push_back(view.half());
    const ImageSweep half(views, sweep.unit() / 2);
    const Imath::Box2i half_data = reduced(data, 2);
    return ImageSearch(half, half_data, halved(tiles, blocks, Tiles(half_data, image_block))).guesses();
}

} // namespace

std::vector<float> ImageGuesses::near(const Imath::Box2i &block) const {
    constexpr int reach = WarpTuning::image_guess_reach;
    const Imath::Box2i around = reduced(block, 2);
    std::vector<float> found;
    for (int y = around.min.y - reach; y <= around.max.y + reach; ++y)
        for (int x = around.min.x - reach; x <= around.max.x + reach; ++x)
            if (grid.contains(Imath::V2i(x, y)) && !std::isnan(depths[grid.index(Imath::V2i(x, y))]))
                found.push_back(2 * depths[grid.index(Imath::V2i(x, y))]);
    return found;
}

ImageSearch::ImageSearch(const ImageSweep &sweep, const Imath::Box2i &data,
                         const std::vector<std::size_t> &blocks)
    : sweep_(sweep), box_(data), tiles_(data, image_block), guesses_(guesses_for(sweep, data, blocks)),
      blocks_(tiles_.count(), not_searched) {
    // Searches band by band, and goes back to the band above if that has new blocks. So the tiles of the views are made
    // once for a band, not once for each ring of blocks around those that found something.
    const std::size_t columns = std::size_t(tiles_.columns()), in_band = band_rows * columns;
    std::vector<std::vector<std::size_t>> waiting(pieces_of(tiles_.count(), in_band));
    const auto add = [&](std::size_t tile) {
        blocks_[tile] = count_++;
        waiting[tile / in_band].push_back(tile);
    };
    std::ranges::for_each(blocks, add);
    for (std::size_t band = 0; band < waiting.size();) {
        const std::vector<std::size_t> next = std::exchange(waiting[band], {});
        matches.resize(count_ * block_pixels);
        std::vector<std::uint8_t> much(next.size());
        sweep_.go_through(next.size(), columns, [&](std::size_t n) { much[n] = search_tile(next[n]); });
        for (std::size_t n = 0; n < next.size(); ++n)
            if (much[n])
                for_each_beside(tiles_, next[n], [&](std::size_t other) {
                    if (blocks_[other] == not_searched) add(other);
                });
        if (band > 0 && !waiting[band - 1].empty())
            --band;
        else if (waiting[band].empty())
            ++band;
    }
}

std::size_t ImageSearch::index_of(const Imath::V2i &pixel) const {
    if (!box_.intersects(pixel)) return npos;
    const auto x = unsigned(pixel.x - box_.min.x), y = unsigned(pixel.y - box_.min.y);
    constexpr auto side = unsigned(image_block);
    const std::uint32_t block = blocks_[std::size_t(y / side) * std::size_t(tiles_.columns()) + x / side];
    return block == not_searched ? npos : block * block_pixels + (y % side) * side + x % side;
}

// Searches a tile. Returns whether much was found.
bool ImageSearch::search_tile(std::size_t tile) {
    const Imath::Box2i block = tiles_.box(tile);
    const std::vector<ImageMatch> found =
        sweep_.search(block, guesses_ ? std::optional(guesses_->near(block)) : std::nullopt);
    const Grid pixels(block);
    std::size_t count = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        matches[index_of(pixels.pixel(i))] = found[i];
        count += found[i].found;
    }
    return double(count) >= WarpTuning::image_enough_found * double(found.size());
}

ImageGuesses ImageSearch::guesses() const {
    const Grid grid(box_);
    ImageGuesses made{grid, std::vector<float>(grid.size(), unknown)};
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const std::size_t index = index_of(grid.pixel(i));
        if (index != npos && matches[index].found) made.depths[i] = matches[index].depth;
    }
    return made;
}

} // namespace sparselens
