// A view as the search for images compares it: bounded colours, smoothed a little, and the depth of its surfaces. Its
// tiles are made when they are first read, because most pictures show few mirrors.
#pragma once

#include "base/grid.h"
#include "deep/view_samples.h"
#include "kernels/surface.h"
#include "view/view_mapping.h"

#include <Imath/ImathVec.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace sparselens {

// The samples of a view, and the mapping that says where its camera stands. Refers to both.
struct PlacedView {
    const ViewSamples *samples;
    const ViewMapping *mapping;
};

// Several threads may read it at the same time.
class MatchedView {
public:
    // R, G and B, bounded so that one bright pixel does not decide, and the disparity of the surface. The depth is NaN
    // if the pixel or one beside it shows several surfaces, none or another one, because the colours are mixed there.
    using Pixel = std::array<float, 4>;

    // `scale` is R F in pixels of the view. `across` of these, across and down, are one pixel here; everything else
    // that is said of pixels, and of depths in pixels, means pixels here. The view must outlive this.
    MatchedView(const PlacedView &view, double scale, int across = 1);

    // The same view with twice as many pixels, across and down, in one.
    MatchedView half() const { return {view_, scale_ * across_, 2 * across_}; }
    int across() const { return across_; }

    bool contains(const Imath::V2i &pixel) const { return grid_.contains(pixel); }
    Pixel at(int x, int y) const;
    // Interpolates between the middles of pixels, which lie at halves. The depth is that of the pixel that contains the
    // position. Returns false outside of the outermost middles.
    bool at(const Imath::V2d &place, Pixel &out) const;

    // A position and `cutout` pixels to the right of it and below, in planes: R, G, B and depth.
    static constexpr int cutout = 16, row = 104 + cutout, plane = row * row; // pixels from one to the next
    struct Cutout {
        // The pixel above and to the left of the position; null if everything lies outside of the view.
        const float *first;
        float right, down; // from there to the position, [0, 1)
    };
    Cutout cut(const Imath::V2d &place) const;

    // The memory of the tiles that are held, bytes.
    std::size_t bytes() const;
    std::size_t bytes_of_row() const { return columns_ * tile_bytes; } // of tiles
    // Frees tiles that were not read since the last call; reading makes them again. No thread may read meanwhile.
    void forget_unused();

    // The depth of the surface, if the pixel shows just one; else NaN.
    float depth(int x, int y) const;

    // Returns where this view shows what the centre view shows at a position; NaN if that lies behind its camera.
    Imath::V2d in_view(const Imath::V2d &place, double depth) const {
        return view_.mapping->in_view(place * double(across_), depth / scale_) * (1.0 / across_);
    }
    const ViewMapping &mapping() const { return *view_.mapping; }
    const ViewSamples &samples() const { return *view_.samples; }

private:
    static constexpr int tile_side = row - cutout; // a tile also holds what may be cut out from its pixels

    static constexpr std::size_t tile_bytes = 4 * std::size_t(plane) * sizeof(float);

    struct Tile {
        std::atomic<bool> is_used = false; // whether it was read lately; then it is made
        std::mutex making;
        std::vector<float> planes; // empty: not made
    };

    // The pixel of that column and line, counted from the window's corner; both may be as low as -cutout.
    const float *from_corner(int column, int line) const {
        const auto x = unsigned(column + cutout), y = unsigned(line + cutout);
        constexpr auto side = unsigned(tile_side);
        const std::size_t tile = std::size_t(y / side) * columns_ + x / side;
        if (!tiles_[tile].is_used.load(std::memory_order_acquire)) use(tile);
        return &tiles_[tile].planes[std::size_t(y % side) * std::size_t(row) + x % side];
    }
    void use(std::size_t tile) const;
    void make(std::size_t tile) const;
    // Reads a line of pixels from `first` to the right: R, G or B, ...
    void colours_of(std::size_t k, const Imath::V2i &first, std::span<float> out) const;
    // ... or depths like depth().
    void depths_of(const Imath::V2i &first, std::span<float> out) const;

    PlacedView view_;
    int across_;
    double scale_; // in pixels here
    std::array<std::size_t, 3> rgb_;
    Grid grid_;
    Imath::V2i corner_;
    std::size_t columns_, count_; // of tiles
    std::unique_ptr<Tile[]> tiles_;
    struct Spare { // memory of tiles that were forgotten
        std::mutex taking;
        std::vector<std::vector<float>> planes;
    };
    std::unique_ptr<Spare> spare_ = std::make_unique<Spare>();
};

inline bool MatchedView::at(const Imath::V2d &place, Pixel &out) const {
    const double x = place.x - 0.5 - corner_.x, y = place.y - 0.5 - corner_.y;
    if (!(x >= 0 && y >= 0 && x < grid_.width() - 1 && y < grid_.height() - 1)) return false;
    const int column = int(x), line = int(y);
    const float u = float(x - column), v = float(y - line);
    const float *p = from_corner(column, line);
    out[3] = p[3 * plane + (v < 0.5f ? 0 : row) + (u < 0.5f ? 0 : 1)];
    for (std::size_t k = 0; k < 3; ++k, p += plane) {
        const float upper = p[0] + u * (p[1] - p[0]), lower = p[row] + u * (p[row + 1] - p[row]);
        out[k] = upper + v * (lower - upper);
    }
    return true;
}

// The pixels of a block and those around it, stored for the search for images, which reads them repeatedly from each
// pixel of the block.
inline constexpr int image_block = 8; // pixels wide and high

// Positions are relative to the upper left pixel of the block.
class Neighbours {
public:
    static constexpr int reach = 8; // pixels around the block

    struct Pixel {
        float own_depth; // disparity, of its surface; NaN: unknown
        float depth;     // of its image; NaN: not known
    };
    template <typename PixelAt>
    explicit Neighbours(const PixelAt &pixel_at) {
        for (int y = -reach; y < image_block + reach; ++y)
            for (int x = -reach; x < image_block + reach; ++x)
                pixels_[at({x, y})] = pixel_at(Imath::V2i(x, y));
    }

    float own_depth(const Imath::V2i &place) const { return pixels_[at(place)].own_depth; }
    float depth(const Imath::V2i &place) const { return pixels_[at(place)].depth; }

    // Calls visit(offset, depth) for the pixels of the same surface within a distance, at most `reach`, including the
    // pixel itself.
    template <typename Visit>
    void for_each_around(const Imath::V2i &place, int distance, const Visit &visit) const {
        const float own = pixels_[at(place)].own_depth;
        for (int y = -distance; y <= distance; ++y) {
            const Pixel *row = &pixels_[at(place + Imath::V2i(0, y))];
            for (int x = -distance; x <= distance; ++x)
                if (kernels::is_one_surface(row[x].own_depth, own, one_mirror_px))
                    visit(Imath::V2i(x, y), row[x].depth);
        }
    }

private:
    static constexpr int side = image_block + 2 * reach;
    static std::size_t at(const Imath::V2i &place) {
        return std::size_t((place.y + reach) * side + place.x + reach);
    }
    std::array<Pixel, std::size_t(side) * side> pixels_;
};

// Fits a plane to values at positions, and gives its value at the origin; the mean of the values if the positions lie
// on a line.
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

} // namespace sparselens
