#include "warp/images/image_depths.h"

#include "base/grid.h"
#include "base/median.h"
#include "warp/images/image_search.h"
#include "warp/images/neighbours.h"
#include "warp/images/robust_mean.h"
#include "warp/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr int near_by = WarpTuning::image_plane_reach, farther = WarpTuning::image_continued_reach;

// Perceptive depths of pixels, by the numbers that the search gives them; NaN: not known.
using Depths = std::vector<float>;

// Makes depths of what the search found, in steps. Each step makes the depths of a block from what the step before made
// of that block and of those around it.
class ImageDepths {
public:
    explicit ImageDepths(const ImageSearch &search)
        : search_(search), sweep_(search.sweep()), matches_(search.matches),
          tried_(matches_.size(), unknown) {}

    void find(const ShowImages &show);

private:
    void agree_with_neighbours(const Imath::Box2i &tile, const Depths &from, Depths &to) const;
    void refine(const Imath::Box2i &tile, const Depths &from, Depths &to) const;
    void go_on(const Imath::Box2i &tile, const Depths &from, Depths &to);
    Neighbours neighbours(const Imath::Box2i &tile, const Depths &depths) const;
    float depth_at(const Imath::V2i &pixel, const Depths &depths) const {
        const std::size_t index = search_.index_of(pixel);
        return index == npos ? unknown : depths[index];
    }

    const ImageSearch &search_;
    const ImageSweep &sweep_;
    const std::vector<ImageMatch> &matches_;
    Depths tried_; // the last depth at which the views did not agree
};

// Returns what is known of the pixels of a tile and around it.
Neighbours ImageDepths::neighbours(const Imath::Box2i &tile, const Depths &depths) const {
    return Neighbours([&](const Imath::V2i &place) -> Neighbours::Pixel {
        const std::size_t index = search_.index_of(tile.min + place);
        if (index == npos || !matches_[index].surface) return {unknown, unknown};
        return {matches_[index].own_depth, depths[index]};
    });
}

// Returns the depth on the plane that fits those depths around that are close enough to `depth` to belong to one image;
// unknown if they are too few.
float depth_on_plane(const Neighbours &neighbours, const Imath::V2i &place, float depth, std::size_t around) {
    LinearFit fit;
    neighbours.for_each_around(place, near_by, [&](const Imath::V2i &offset, float other) {
        if (std::abs(other - depth) <= WarpTuning::image_one_px) fit.add(Imath::V2d(offset), double(other));
    });
    return fit.count() >= WarpTuning::image_agreement * double(around) ? float(fit.at_origin()) : unknown;
}

// Returns the depth on a plane through depths near the pixel's own depth, else near the median of the depths around;
// unknown if those are too few.
float depth_by_neighbours(const Neighbours &neighbours, const Imath::V2i &place, std::vector<float> &around) {
    around.clear();
    std::size_t pixels = 0;
    neighbours.for_each_around(place, near_by, [&](const Imath::V2i &, float depth) {
        ++pixels;
        if (!std::isnan(depth)) around.push_back(depth);
    });
    if (double(around.size()) < WarpTuning::image_agreement * double(pixels)) return unknown;
    const float own = depth_on_plane(neighbours, place, neighbours.depth(place), around.size());
    return std::isnan(own) ? depth_on_plane(neighbours, place, median(around), around.size()) : own;
}

void ImageDepths::agree_with_neighbours(const Imath::Box2i &tile, const Depths &from, Depths &to) const {
    const Neighbours around_tile = neighbours(tile, from);
    std::vector<float> around;
    const Grid pixels(tile);
    for (std::size_t n = 0; n < pixels.size(); ++n) {
        const Imath::V2i pixel = pixels.pixel(n);
        const std::size_t index = search_.index_of(pixel);
        to[index] =
            std::isnan(from[index]) ? unknown : depth_by_neighbours(around_tile, pixel - tile.min, around);
    }
}

// Refines depths. Unlike in the search, a patch need not lie at one depth.
void ImageDepths::refine(const Imath::Box2i &tile, const Depths &from, Depths &to) const {
    const std::vector<float> refined =
        sweep_.refined(tile, [&](const Imath::V2i &p) { return depth_at(p, from); });
    const Grid pixels(tile);
    for (std::size_t n = 0; n < pixels.size(); ++n) to[search_.index_of(pixels.pixel(n))] = refined[n];
}

// The median of the depths around; unknown if those are too few.
float depth_around(const Neighbours &neighbours, const Imath::V2i &place, std::vector<float> &around) {
    around.clear();
    neighbours.for_each_around(place, farther, [&](const Imath::V2i &, float depth) {
        if (!std::isnan(depth)) around.push_back(depth);
    });
    return around.size() < WarpTuning::image_least_sources ? unknown : median(around);
}

// Continues depths to pixels of the same surface, if the views agree there about as well as on the surface.
void ImageDepths::go_on(const Imath::Box2i &tile, const Depths &from, Depths &to) {
    const Neighbours around_tile = neighbours(tile, from);
    const Grid pixels(tile);
    std::vector<float> around, depths(pixels.size(), unknown);
    std::array<Neighbours::Pixel, image_block * image_block / 4> of_four;
    of_four.fill({unknown, unknown}); // pixels side by side have the same pixels around them
    for (std::size_t n = 0; n < pixels.size(); ++n) {
        const std::size_t index = search_.index_of(pixels.pixel(n));
        to[index] = from[index];
        if (!matches_[index].surface || !std::isnan(from[index])) continue;
        const Imath::V2i place = pixels.pixel(n) - tile.min;
        auto &[own, depth] = of_four[std::size_t(place.y / 2 * (image_block / 2) + place.x / 2)];
        if (!kernels::is_one_surface(own, matches_[index].own_depth, one_mirror_px)) {
            own = matches_[index].own_depth;
            depth = depth_around(around_tile, place, around);
        }
        if (depth != tried_[index]) depths[n] = tried_[index] = depth;
    }
    if (std::ranges::all_of(depths, [](float depth) { return std::isnan(depth); })) return;
    const auto tried_at = [&](const Imath::V2i &p) {
        const float depth = tile.intersects(p) ? depths[pixels.index(p.x, p.y)] : unknown;
        return std::isnan(depth) ? depth_at(p, from) : depth;
    };
    const std::vector<float> means = robust_means(sweep_.differences(tile, tried_at), pixels.size());
    for (std::size_t n = 0; n < pixels.size(); ++n) {
        const std::size_t index = search_.index_of(pixels.pixel(n));
        const float most = WarpTuning::image_continued_difference * matches_[index].at_surface +
                           WarpTuning::image_continued_least_difference;
        if (!std::isnan(depths[n]) && means[n] <= most) to[index] = depths[n];
    }
}

// Each step follows the one before down the picture, a band behind it, so that they read the same tiles of the views.
void ImageDepths::find(const ShowImages &show) {
    constexpr std::size_t made = 3 + WarpTuning::image_continuations, // steps that make depths
        // rows of blocks; a step looks one row beyond
        band_rows = 2;
    std::array<Depths, 3> depths; // a later step overwrites what a step reads of a band
    depths.fill(Depths(matches_.size(), unknown));
    for (std::size_t i = 0; i < matches_.size(); ++i)
        if (matches_[i].found) depths[0][i] = matches_[i].depth;
    const auto take = [&](std::size_t step, const Imath::Box2i &tile) {
        const Depths &from = depths[step % 3];
        Depths &to = depths[(step + 1) % 3];
        if (step == made) return show(tile, [&](const Imath::V2i &pixel) { return depth_at(pixel, from); });
        if (step == 1) return refine(tile, from, to);
        if (step < 3) return agree_with_neighbours(tile, from, to);
        go_on(tile, from, to);
    };
    const std::size_t bands = search_.bands(band_rows);
    for (std::size_t time = 0; time < bands + made; ++time)
        for (std::size_t step = time - std::min(time, bands - 1); step <= std::min(time, made); ++step)
            search_.for_each_searched(band_rows, time - step,
                                      [&](const Imath::Box2i &tile) { take(step, tile); });
}

} // namespace

std::vector<std::size_t> blocks_to_search(const Imath::Box2i &data, std::span<const Disagreement> differ) {
    const Tiles tiles(data, image_block);
    std::vector<std::size_t> blocks;
    for (std::size_t tile = 0; tile < tiles.count(); ++tile) {
        int beside = 0;
        for_each_beside(tiles, tile,
                        [&](std::size_t other) { beside += differ[other] != Disagreement::none; });
        const bool clear = differ[tile] == Disagreement::clear, slight = differ[tile] == Disagreement::slight;
        if ((clear && beside > 0) || (slight && beside >= WarpTuning::image_enough_beside))
            blocks.push_back(tile);
    }
    return blocks;
}

void find_image_depths(const ImageSweep &sweep, const Imath::Box2i &data,
                       const std::vector<std::size_t> &blocks, const ShowImages &show) {
    const ImageSearch search(sweep, data, blocks);
    ImageDepths(search).find(show);
}

} // namespace sparselens
