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
#include <utility>

namespace sparselens {

namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr int near_by = WarpTuning::image_plane_reach, farther = WarpTuning::image_continued_reach;

class ImageDepths {
public:
    explicit ImageDepths(ImageSearch &search)
        : search_(search), sweep_(search.sweep()), matches_(search.matches),
          depths_(matches_.size(), unknown), tried_(depths_) {}

    void agree_with_neighbours();
    void refine();
    void go_on();
    // By pixel of the data window, row by row.
    std::vector<float> all() const;

private:
    // What is known of the pixels of a tile and around; depth_at(index) says it of images.
    template <typename DepthAt>
    Neighbours neighbours(const Imath::Box2i &tile, const DepthAt &depth_at) const;
    float continued(const Neighbours &neighbours, const Imath::V2i &place, const Imath::V2i &pixel,
                    const ImageMatch &match, std::vector<float> &around, float &tried) const;

    const ImageSearch &search_;
    const ImageSweep &sweep_;
    std::vector<ImageMatch> &matches_; // by pixel, as the search numbers them
    std::vector<float> depths_;
    std::vector<float> tried_; // the last depth at which the views did not agree
};

template <typename DepthAt>
Neighbours ImageDepths::neighbours(const Imath::Box2i &tile, const DepthAt &depth_at) const {
    return Neighbours([&](const Imath::V2i &place) -> Neighbours::Pixel {
        const std::size_t index = search_.index_of(tile.min + place);
        if (index == npos || !matches_[index].surface) return {unknown, unknown};
        return {matches_[index].own_depth, depth_at(index)};
    });
}

// On the plane that fits the depths around which are as near to that one as those of one image are; unknown if those are too few.
float depth_on_plane(const Neighbours &neighbours, const Imath::V2i &place, float depth, std::size_t around) {
    LinearFit fit;
    neighbours.for_each_around(place, near_by, [&](const Imath::V2i &offset, float other) {
        if (std::abs(other - depth) <= WarpTuning::image_one_px) fit.add(Imath::V2d(offset), double(other));
    });
    return fit.count() >= WarpTuning::image_agreement * double(around) ? float(fit.at_origin()) : unknown;
}

// By the pixel's own depth, else by the median of those around; unknown if those are too few.
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

void ImageDepths::agree_with_neighbours() {
    search_.for_each_searched([&](const Imath::Box2i &tile) {
        const Neighbours around_tile = neighbours(
            tile, [&](std::size_t index) { return matches_[index].found ? matches_[index].depth : unknown; });
        std::vector<float> around;
        const Grid pixels(tile);
        for (std::size_t n = 0; n < pixels.size(); ++n) {
            const Imath::V2i pixel = pixels.pixel(n);
            const std::size_t index = search_.index_of(pixel);
            if (matches_[index].found)
                depths_[index] = depth_by_neighbours(around_tile, pixel - tile.min, around);
        }
    });
}

// A patch need not lie at one depth.
void ImageDepths::refine() {
    const auto depth_at = [&](const Imath::V2i &p) {
        const std::size_t index = search_.index_of(p);
        return index == npos ? unknown : depths_[index];
    };
    std::vector<float> next(depths_.size(), unknown);
    search_.for_each_searched([&](const Imath::Box2i &block) {
        const std::vector<float> refined = sweep_.refined(block, depth_at);
        const Grid pixels(block);
        for (std::size_t n = 0; n < pixels.size(); ++n) next[search_.index_of(pixels.pixel(n))] = refined[n];
    });
    for (std::size_t i = 0; i < matches_.size(); ++i) {
        matches_[i].found = !std::isnan(next[i]);
        if (matches_[i].found) matches_[i].depth = next[i];
    }
}

// The median of the depths around, if the views agree about as well there as on the surface.
float ImageDepths::continued(const Neighbours &neighbours, const Imath::V2i &place, const Imath::V2i &pixel,
                             const ImageMatch &match, std::vector<float> &around, float &tried) const {
    around.clear();
    neighbours.for_each_around(place, farther, [&](const Imath::V2i &, float depth) {
        if (!std::isnan(depth)) around.push_back(depth);
    });
    if (around.size() < WarpTuning::image_least_sources) return unknown;
    const float depth = median(around);
    if (depth == tried) return unknown;
    tried = depth;
    const float there = robust_mean(sweep_.differences(pixel, double(depth)));
    return there <= WarpTuning::image_continued_difference * match.at_surface +
                        WarpTuning::image_continued_least_difference
               ? depth
               : unknown;
}

void ImageDepths::go_on() {
    std::vector<float> next = depths_;
    search_.for_each_searched([&](const Imath::Box2i &tile) {
        const Neighbours around_tile = neighbours(tile, [&](std::size_t index) { return depths_[index]; });
        std::vector<float> around;
        const Grid pixels(tile);
        for (std::size_t n = 0; n < pixels.size(); ++n) {
            const Imath::V2i pixel = pixels.pixel(n);
            const std::size_t index = search_.index_of(pixel);
            if (matches_[index].surface && std::isnan(depths_[index]))
                next[index] =
                    continued(around_tile, pixel - tile.min, pixel, matches_[index], around, tried_[index]);
        }
    });
    depths_ = std::move(next);
}

std::vector<float> ImageDepths::all() const {
    const Grid grid(search_.box());
    std::vector<float> depths(grid.size(), unknown);
    search_.for_each_searched([&](const Imath::Box2i &tile) {
        const Grid pixels(tile);
        for (std::size_t n = 0; n < pixels.size(); ++n) {
            const Imath::V2i pixel = pixels.pixel(n);
            depths[grid.index(pixel.x, pixel.y)] = depths_[search_.index_of(pixel)];
        }
    });
    return depths;
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

std::vector<float> find_image_depths(const ImageSweep &sweep, const Imath::Box2i &data,
                                     const std::vector<std::size_t> &blocks) {
    ImageSearch search(sweep, data, blocks);
    ImageDepths depths(search);
    depths.agree_with_neighbours();
    depths.refine();
    depths.agree_with_neighbours();
    for (int n = 0; n < WarpTuning::image_continuations; ++n) depths.go_on();
    return depths.all();
}

} // namespace sparselens
