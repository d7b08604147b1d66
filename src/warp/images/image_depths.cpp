#include "warp/images/image_depths.h"

#include "base/grid.h"
#include "base/median.h"
#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr double enough_found = 0.25; // of the pixels of a block, to search those beside it
constexpr int enough_beside = 2;      // of the eight blocks beside one: more than a line ends with
constexpr int near_by = 6;            // pixels, for the plane
constexpr double agreement =
    0.4; // of the pixels around that found a depth are as near to it as the next says
constexpr float one_image = 0.8f; // pixels of perceptive depth
constexpr int farther = 8;        // pixels from which a depth may be continued
constexpr std::size_t least_sources = 8;
constexpr int continuations = 2;
constexpr float no_worse = 1.25f; // than at the surface may the views agree at a continued depth
constexpr float least_difference = 1e-5f;

// visit(column, row) for the tiles around one.
template <typename Visit>
void for_each_beside(const Tiles &tiles, std::size_t tile, const Visit &visit) {
    const int column = int(tile) % tiles.columns(), row = int(tile) / tiles.columns();
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, tiles.rows() - 1); ++r)
        for (int c = std::max(column - 1, 0); c <= std::min(column + 1, tiles.columns() - 1); ++c)
            if (c != column || r != row) visit(std::size_t(r * tiles.columns() + c));
}

// The value at the origin of the plane that fits values at places best; their mean where they lie on a line.
class LinearFit {
public:
    void add(const Imath::V2d &p, double value) {
        n_ += 1, x_ += p.x, y_ += p.y, xx_ += p.x * p.x, xy_ += p.x * p.y, yy_ += p.y * p.y;
        v_ += value, vx_ += value * p.x, vy_ += value * p.y;
    }
    double count() const { return n_; }
    double at_origin() const {
        const double xx = xx_ - x_ * x_ / n_, xy = xy_ - x_ * y_ / n_, yy = yy_ - y_ * y_ / n_;
        const double vx = vx_ - v_ * x_ / n_, vy = vy_ - v_ * y_ / n_, det = xx * yy - xy * xy;
        if (!(det > 1e-6 * xx * yy)) return v_ / n_;
        return (v_ - x_ * (vx * yy - vy * xy) / det - y_ * (vy * xx - vx * xy) / det) / n_;
    }

private:
    double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0, v_ = 0, vx_ = 0, vy_ = 0;
};

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
    struct Place {
        Imath::V2i pixel;
        std::size_t index; // of the arrays by pixel
    };
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
    bool one_surface_with(const ImageMatch &a, const ImageMatch &b) const {
        return a.surface && b.surface && kernels::is_one_surface(a.own_depth, b.own_depth, one_mirror_px);
    }
    // visit(place, scratch) for the pixels of the tiles that were searched.
    template <typename Visit>
    void for_each_searched(const Visit &visit) const;
    // visit(place) for the pixels of the same surface around one, itself among them.
    template <typename Visit>
    void for_each_around(const Place &at, int distance, const Visit &visit) const;
    float depth_by_neighbours(const Place &at, std::vector<float> &around) const;
    float continued(const Place &at, std::vector<float> &around) const;

    const ImageSweep &sweep_;
    Imath::Box2i box_;
    Tiles tiles_;
    std::vector<std::uint32_t> blocks_; // by tile: which block of the arrays it is
    std::uint32_t count_ = 0;           // of blocks
    std::vector<ImageMatch> matches_;   // by pixel, block by block
    std::vector<float> depths_;
};

template <typename Visit>
void ImageDepths::for_each_searched(const Visit &visit) const {
    parallel_for(tiles_.count(), [&](std::size_t tile) {
        if (blocks_[tile] == not_searched) return;
        std::vector<float> scratch;
        const Grid pixels(tiles_.box(tile));
        for (std::size_t n = 0; n < pixels.size(); ++n) {
            const Imath::V2i pixel = pixels.pixel(n);
            visit(Place{pixel, index_of(pixel)}, scratch);
        }
    });
}

template <typename Visit>
void ImageDepths::for_each_around(const Place &at, int distance, const Visit &visit) const {
    const Imath::V2i p = at.pixel;
    for (int y = std::max(p.y - distance, box_.min.y); y <= std::min(p.y + distance, box_.max.y); ++y)
        for (int x = std::max(p.x - distance, box_.min.x); x <= std::min(p.x + distance, box_.max.x); ++x) {
            const std::size_t other = index_of({x, y});
            if (other != npos && one_surface_with(matches_[at.index], matches_[other]))
                visit(Place{{x, y}, other});
        }
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
    return double(count) >= enough_found * double(found.size());
}

void ImageDepths::search(std::vector<std::size_t> next) {
    for (const std::size_t tile : next) add_block(tile);
    while (!next.empty()) {
        matches_.resize(count_ * block_pixels);
        std::vector<std::uint8_t> much(next.size());
        parallel_for(next.size(), [&](std::size_t n) { much[n] = search_tile(next[n]); });
        std::vector<std::size_t> beside;
        for (std::size_t n = 0; n < next.size(); ++n)
            if (much[n])
                for_each_beside(tiles_, next[n], [&](std::size_t other) {
                    if (blocks_[other] == not_searched) beside.push_back(other), add_block(other);
                });
        next = std::move(beside);
    }
    depths_.assign(matches_.size(), unknown);
}

// On the plane that fits the depths around as near to the pixel's own, else to their median, as those of one image are;
// unknown if those are too few.
float ImageDepths::depth_by_neighbours(const Place &at, std::vector<float> &around) const {
    around.clear();
    std::size_t pixels = 0;
    for_each_around(at, near_by, [&](const Place &other) {
        ++pixels;
        if (matches_[other.index].found) around.push_back(matches_[other.index].depth);
    });
    if (double(around.size()) < agreement * double(pixels)) return unknown;
    for (const float depth : {matches_[at.index].depth, median(around)}) {
        LinearFit fit;
        for_each_around(at, near_by, [&](const Place &other) {
            const ImageMatch &match = matches_[other.index];
            if (match.found && std::abs(match.depth - depth) <= one_image)
                fit.add(Imath::V2d(other.pixel - at.pixel), double(match.depth));
        });
        if (fit.count() >= agreement * double(around.size())) return float(fit.at_origin());
    }
    return unknown;
}

void ImageDepths::agree_with_neighbours() {
    for_each_searched([&](const Place &at, std::vector<float> &around) {
        if (matches_[at.index].found) depths_[at.index] = depth_by_neighbours(at, around);
    });
}

// A patch need not lie at one depth.
void ImageDepths::refine() {
    const auto depth_at = [&](const Imath::V2i &p) {
        const std::size_t index = box_.intersects(p) ? index_of(p) : npos;
        return index == npos ? unknown : depths_[index];
    };
    std::vector<float> next(depths_.size(), unknown);
    parallel_for(tiles_.count(), [&](std::size_t tile) {
        if (blocks_[tile] == not_searched) return;
        const Imath::Box2i block = tiles_.box(tile);
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
float ImageDepths::continued(const Place &at, std::vector<float> &around) const {
    around.clear();
    for_each_around(at, farther, [&](const Place &other) {
        if (!std::isnan(depths_[other.index])) around.push_back(depths_[other.index]);
    });
    if (around.size() < least_sources) return unknown;
    const float depth = median(around);
    std::vector<float> differences = sweep_.differences(at.pixel, double(depth));
    const float there = robust_mean(differences);
    return there <= no_worse * matches_[at.index].at_surface + least_difference ? depth : unknown;
}

void ImageDepths::go_on() {
    std::vector<float> next = depths_;
    for_each_searched([&](const Place &at, std::vector<float> &around) {
        if (matches_[at.index].surface && std::isnan(depths_[at.index]))
            next[at.index] = continued(at, around);
    });
    depths_ = std::move(next);
}

std::vector<float> ImageDepths::all() const {
    const Grid grid(box_);
    std::vector<float> depths(grid.size(), unknown);
    for_each_searched([&](const Place &at, std::vector<float> &) {
        depths[grid.index(at.pixel.x, at.pixel.y)] = depths_[at.index];
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
        if ((clear && beside > 0) || (slight && beside >= enough_beside)) blocks.push_back(tile);
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
    for (int n = 0; n < continuations; ++n) depths.go_on();
    return depths.all();
}

} // namespace sparselens
