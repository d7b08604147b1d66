// A view as the search for images compares it: bounded colours, smoothed a little, and the depth of its surfaces. Made
// tile by tile where it is looked at: most pictures show few mirrors.
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

// A view of one sample a pixel or, on silhouettes, more; the mapping tells where it stands.
struct PlacedView {
    const ViewSamples *samples;
    const ViewMapping *mapping;
};

// Several threads may look at one.
class MatchedView {
public:
    // R, G and B, bounded so that one bright pixel does not decide, and the perceptive depth of the surface, which
    // is NaN where the pixel or one beside it shows several surfaces, none or another one: the colours are mixed there.
    using Pixel = std::array<float, 4>;

    // `scale` is R F in pixels of the view, of which `across`, across and down, are one here: all that is said of pixels, of
    // their depths too, is said of those. The view must outlive this.
    MatchedView(const PlacedView &view, double scale, int across = 1);

    // The same view where twice as many, across and down, are one.
    MatchedView half() const { return {view_, scale_ * across_, 2 * across_}; }
    int across() const { return across_; }

    bool contains(int x, int y) const { return grid_.contains(x, y); }
    Pixel at(int x, int y) const;
    // Between the middles of pixels, which lie at halves; the depth is that of the pixel which holds the place. False
    // outside of them.
    bool at(const Imath::V2d &place, Pixel &out) const;

    // A place and what lies to the right of it and below, for `cutout` pixels, in planes: R, G, B and depth.
    static constexpr int cutout = 16, row = 104 + cutout, plane = row * row; // pixels from one to the next
    struct Cutout {
        const float
            *first; // the pixel above and to the left of the place; null if all lies outside of the view
        float right, down; // from there to the place, [0, 1)
    };
    Cutout cut(const Imath::V2d &place) const;

    // Memory of the tiles that were made and are held.
    std::size_t bytes() const;
    std::size_t bytes_of_row() const { return columns_ * tile_bytes; } // of tiles
    // Frees tiles that were not read since the last call; reading makes them again. No thread may read meanwhile.
    void forget_unused();

    // The depth of the surface, if the pixel shows just one; else NaN.
    float depth(int x, int y) const;

    // Where it shows what the centre view shows at that place; NaN where that lies behind its camera.
    Imath::V2d in_view(const Imath::V2d &place, double depth) const {
        return view_.mapping->in_view(place * double(across_), depth / scale_) * (1.0 / across_);
    }
    const ViewMapping &mapping() const { return *view_.mapping; }
    const ViewSamples &samples() const { return *view_.samples; }

private:
    static constexpr int tile_side = row - cutout; // a tile holds what may be cut out from its pixels, too

    static constexpr std::size_t tile_bytes = 4 * std::size_t(plane) * sizeof(float);

    struct Tile {
        std::atomic<bool> is_used = false; // lately; then it is made
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
    // Reads pixels from one to the right: R, G or B, ...
    void colours_of(std::size_t k, const Imath::V2i &first, std::span<float> out) const;
    // ... and as depth().
    void depths_of(const Imath::V2i &first, std::span<float> out) const;

    PlacedView view_;
    int across_;
    double scale_; // in pixels of this
    std::array<std::size_t, 3> rgb_;
    Grid grid_;
    Imath::V2i corner_;
    std::size_t columns_, count_; // of tiles
    std::unique_ptr<Tile[]> tiles_;
    struct Spare { // what tiles had that were forgotten
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
