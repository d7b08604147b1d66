// A view as the search for images compares it: bounded colours, smoothed a little, and the depth of its surfaces. Its
// tiles are made when they are first read, because most pictures show few mirrors.
#pragma once

#include "base/grid.h"
#include "deep/view_samples.h"
#include "kernels/surface.h"
#include "view/view_mapping.h"

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace sparselens {

// A view with one sample per pixel, or more on silhouettes. The mapping says where its camera stands.
struct PlacedView {
    const ViewSamples *samples;
    const ViewMapping *mapping;
};

// Several threads may read it at the same time.
class MatchedView {
public:
    // R, G and B, bounded so that one bright pixel does not decide, and the perceptive depth of the surface. The depth
    // is NaN if the pixel or one beside it shows several surfaces, none or another one, because the colours are mixed
    // there.
    using Pixel = std::array<float, 4>;

    // `scale` is R F in pixels of the view. `across` of these, across and down, are one pixel here; everything else
    // that is said of pixels, and of depths in pixels, means pixels here. The view must outlive this.
    MatchedView(const PlacedView &view, double scale, int across = 1);

    // The same view with twice as many pixels, across and down, in one.
    MatchedView half() const { return {view_, scale_ * across_, 2 * across_}; }
    int across() const { return across_; }

    bool contains(int x, int y) const { return grid_.contains(x, y); }
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

} // namespace sparselens
