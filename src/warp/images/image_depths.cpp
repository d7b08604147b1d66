#include "warp/images/image_depths.h"

#include "base/grid.h"
#include "base/median.h"
#include "base/parallel.h"
#include "warp/images/robust_mean.h"
#include "warp/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr int near_by = WarpTuning::image_plane_reach, farther = WarpTuning::image_continued_reach;
constexpr std::size_t rows_at_once = 8; // of blocks

// visit(column, row) for the tiles around one.
template <typename Visit>
void for_each_beside(const Tiles &tiles, std::size_t tile, const Visit &visit) {
    const int column = int(tile) % tiles.columns(), row = int(tile) / tiles.columns();
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, tiles.rows() - 1); ++r)
        for (int c = std::max(column - 1, 0); c <= std::min(column + 1, tiles.columns() - 1); ++c)
            if (c != column || r != row) visit(std::size_t(r * tiles.columns() + c));
}

// Of the blocks that are searched alone: most pictures show few mirrors.
class ImageDepths {
public:
    ImageDepths(const ImageSweep &sweep, const Imath::Box2i &data)
        : sweep_(sweep), box_(data), tiles_(data, image_block), blocks_(tiles_.count(), not_searched) {}

    void search(std::vector<std::size_t> next);
    void agree_with_neighbours();
    void refine();
    void go_on();
    // By pixel of the data window, row by row.
    std::vector<float> all() const;

private:
    static constexpr std::uint32_t not_searched = ~0u;
    static constexpr std::size_t block_pixels = std::size_t(image_block) * image_block;

    // npos: not searched.
    std::size_t index_of(const Imath::V2i &pixel) const {
        const auto x = unsigned(pixel.x - box_.min.x), y = unsigned(pixel.y - box_.min.y);
        constexpr auto side = unsigned(image_block);
        const std::uint32_t block = blocks_[std::size_t(y / side) * std::size_t(tiles_.columns()) + x / side];
        return block == not_searched ? npos : block * block_pixels + (y % side) * side + x % side;
    }
    void add_block(std::size_t tile) { blocks_[tile] = count_++; }
    bool search_tile(std::size_t tile);
    // visit(tile) for those that were searched.
    template <typename Visit>
    void for_each_searched(const Visit &visit) const;
    // What is known of the pixels of a tile and around; depth_at(index) says it of images.
    template <typename DepthAt>
    Neighbours neighbours(const Imath::Box2i &tile, const DepthAt &depth_at) const;
    float continued(const Neighbours &neighbours, const Imath::V2i &place, const Imath::V2i &pixel,
                    const ImageMatch &match, std::vector<float> &around, float &tried) const;

    const ImageSweep &sweep_;
    Imath::Box2i box_;
    Tiles tiles_;
    std::vector<std::uint32_t> blocks_; // by tile: which block of the arrays it is
    std::uint32_t count_ = 0;           // of blocks
    std::vector<ImageMatch> matches_;   // by pixel, block by block
    std::vector<float> depths_;
    std::vector<float> tried_; // the last depth at which the views did not agree
};

template <typename Visit>
void ImageDepths::for_each_searched(const Visit &visit) const {
    sweep_.go_through(tiles_.count(), rows_at_once * std::size_t(tiles_.columns()), [&](std::size_t tile) {
        if (blocks_[tile] != not_searched) visit(tiles_.box(tile));
    });
}

template <typename DepthAt>
Neighbours ImageDepths::neighbours(const Imath::Box2i &tile, const DepthAt &depth_at) const {
    return Neighbours([&](const Imath::V2i &place) -> Neighbours::Pixel {
        const Imath::V2i pixel = tile.min + place;
        const std::size_t index = box_.intersects(pixel) ? index_of(pixel) : npos;
        if (index == npos || !matches_[index].surface) return {unknown, unknown};
        return {matches_[index].own_depth, depth_at(index)};
    });
}

// Whether much was found.
bool ImageDepths::search_tile(std::size_t tile) {
    const Imath::Box2i block = tiles_.box(tile);
    const std::vector<ImageMatch> found = sweep_.search(block);
    const Grid pixels(block);
    std::size_t count = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        matches_[index_of(pixels.pixel(i))] = found[i];
        count += found[i].found;
    }
    return double(count) >= WarpTuning::image_enough_found * double(found.size());
}

void ImageDepths::search(std::vector<std::size_t> next) {
    for (const std::size_t tile : next) add_block(tile);
    while (!next.empty()) {
        matches_.resize(count_ * block_pixels);
        std::vector<std::uint8_t> much(next.size());
        sweep_.go_through(next.size(), std::size_t(tiles_.columns()),
                          [&](std::size_t n) { much[n] = search_tile(next[n]); });
        std::vector<std::size_t> beside;
        for (std::size_t n = 0; n < next.size(); ++n)
            if (much[n])
                for_each_beside(tiles_, next[n], [&](std::size_t other) {
                    if (blocks_[other] == not_searched) beside.push_back(other), add_block(other);
                });
        next = std::move(beside);
    }
    depths_.assign(matches_.size(), unknown);
    tried_ = depths_;
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
    for_each_searched([&](const Imath::Box2i &tile) {
        const Neighbours around_tile = neighbours(
            tile, [&](std::size_t index) { return matches_[index].found ? matches_[index].depth : unknown; });
        std::vector<float> around;
        const Grid pixels(tile);
        for (std::size_t n = 0; n < pixels.size(); ++n) {
            const Imath::V2i pixel = pixels.pixel(n);
            const std::size_t index = index_of(pixel);
            if (matches_[index].found)
                depths_[index] = depth_by_neighbours(around_tile, pixel - tile.min, around);
        }
    });
}

// A patch need not lie at one depth.
void ImageDepths::refine() {
    const auto depth_at = [&](const Imath::V2i &p) {
        const std::size_t index = box_.intersects(p) ? index_of(p) : npos;
        return index == npos ? unknown : depths_[index];
    };
    std::vector<float> next(depths_.size(), unknown);
    for_each_searched([&](const Imath::Box2i &block) {
        const std::vector<float> refined = sweep_.refined(block, depth_at);
        const Grid pixels(block);
        for (std::size_t n = 0; n < pixels.size(); ++n) next[index_of(pixels.pixel(n))] = refined[n];
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
    for_each_searched([&](const Imath::Box2i &tile) {
        const Neighbours around_tile = neighbours(tile, [&](std::size_t index) { return depths_[index]; });
        std::vector<float> around;
        const Grid pixels(tile);
        for (std::size_t n = 0; n < pixels.size(); ++n) {
            const Imath::V2i pixel = pixels.pixel(n);
            const std::size_t index = index_of(pixel);
            if (matches_[index].surface && std::isnan(depths_[index]))
                next[index] =
                    continued(around_tile, pixel - tile.min, pixel, matches_[index], around, tried_[index]);
        }
    });
    depths_ = std::move(next);
}

std::vector<float> ImageDepths::all() const {
    const Grid grid(box_);
    std::vector<float> depths(grid.size(), unknown);
    for_each_searched([&](const Imath::Box2i &tile) {
        const Grid pixels(tile);
        for (std::size_t n = 0; n < pixels.size(); ++n) {
            const Imath::V2i pixel = pixels.pixel(n);
            depths[grid.index(pixel.x, pixel.y)] = depths_[index_of(pixel)];
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
    ImageDepths depths(sweep, data);
    depths.search(blocks);
    depths.agree_with_neighbours();
    depths.refine();
    depths.agree_with_neighbours();
    for (int n = 0; n < WarpTuning::image_continuations; ++n) depths.go_on();
    return depths.all();
}

} // namespace sparselens
