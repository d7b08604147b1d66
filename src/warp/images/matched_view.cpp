#include "warp/images/matched_view.h"

#include "kernels/photo_rules.h"
#include "lens/perceptive_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

float smoothed(float before, float middle, float after) { return 0.25f * (before + 2 * middle + after); }

// A square of pixels, row by row, and one with a pixel more on every side.
struct Square {
    int side;
    int wide() const { return side + 2; }
    std::size_t at(int x, int y) const { return std::size_t(y * side + x); }
    std::size_t around(int x, int y) const { return std::size_t((y + 1) * wide() + x + 1); }

    // By (1, 2, 1) / 4 along both axes: what lies between pixels is then about as noisy as what lies on them, and a step
    // of half a pixel follows the texture.
    void smooth(const float *from, float *to) const {
        std::vector<float> lines(std::size_t(side * wide()));
        for (int y = -1; y <= side; ++y) {
            const float *line = from + around(0, y);
            for (int x = 0; x < side; ++x) lines[at(x, y + 1)] = smoothed(line[x - 1], line[x], line[x + 1]);
        }
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                to[at(x, y)] = smoothed(lines[at(x, y)], lines[at(x, y + 1)], lines[at(x, y + 2)]);
    }

    // The depth of a pixel if it and all those around show one surface.
    void keep_one_surface(const float *from, float *to) const {
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const float own = from[around(x, y)];
                bool one = true;
                for (int v = y - 1; v <= y + 1; ++v)
                    for (int u = x - 1; u <= x + 1; ++u)
                        one &= kernels::is_one_surface(from[around(u, v)], own, one_mirror_px);
                to[at(x, y)] = one ? own : unknown;
            }
    }
};

} // namespace

MatchedView::MatchedView(const PlacedView &view, double scale)
    : view_(view), scale_(scale), rgb_(find_rgb(view.samples->channels)), grid_(view.samples->windows.grid()),
      corner_(grid_.box().min) {
    columns_ = std::size_t(pieces_of(grid_.width() + cutout, tile_side));
    count_ = columns_ * std::size_t(pieces_of(grid_.height() + cutout, tile_side));
    forget();
}

void MatchedView::forget() { tiles_ = std::make_unique<Tile[]>(count_); }

std::size_t MatchedView::bytes() const {
    const std::span<const Tile> tiles(tiles_.get(), count_);
    const auto made = std::ranges::count_if(tiles, [](const Tile &tile) { return tile.is_made.load(); });
    return std::size_t(made) * tile_bytes;
}

float MatchedView::depth(int x, int y) const {
    if (!contains(x, y)) return unknown;
    const ViewSamples &view = *view_.samples;
    const SampleRange samples = view.pixel(grid_.index(x, y));
    return samples.size() == 1 ? float(perceptive_depth(scale_, double(view.z(samples.front())))) : unknown;
}

// What lies outside has the colours of the border, and no depth.
void MatchedView::make(std::size_t tile) const {
    std::call_once(tiles_[tile].making, [&] {
        constexpr Square square{row};
        const Imath::V2i at(int(tile % columns_), int(tile / columns_));
        const Imath::V2i first = corner_ + at * tile_side - Imath::V2i(cutout);
        const Imath::Box2i frame = grid_.box();
        const ViewSamples &view = *view_.samples;
        constexpr auto size = std::size_t((row + 2) * (row + 2)), out_size = std::size_t(plane);
        std::vector<float> sharp(4 * size);
        for (int y = -1; y <= row; ++y)
            for (int x = -1; x <= row; ++x) {
                const Imath::V2i p = first + Imath::V2i(x, y);
                const SampleRange samples = view.pixel(grid_.index(
                    std::clamp(p.x, frame.min.x, frame.max.x), std::clamp(p.y, frame.min.y, frame.max.y)));
                const std::size_t i = square.around(x, y);
                for (std::size_t k = 0; k < 3 && !samples.empty(); ++k)
                    if (rgb_[k] != npos)
                        sharp[k * size + i] = kernels::bounded(view.value(rgb_[k], samples.front()));
                sharp[3 * size + i] = depth(p.x, p.y);
            }
        std::vector<float> &planes = tiles_[tile].planes;
        planes.resize(4 * out_size);
        for (std::size_t k = 0; k < 3; ++k) square.smooth(&sharp[k * size], &planes[k * out_size]);
        square.keep_one_surface(&sharp[3 * size], &planes[3 * out_size]);
        tiles_[tile].is_made.store(true, std::memory_order_release);
    });
}

MatchedView::Pixel MatchedView::at(int x, int y) const {
    const float *p = from_corner(x - corner_.x, y - corner_.y);
    return {p[0], p[plane], p[2 * plane], p[3 * plane]};
}

bool MatchedView::at(const Imath::V2d &place, Pixel &out) const {
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

MatchedView::Cutout MatchedView::cut(const Imath::V2d &place) const {
    const double x = place.x - 0.5 - corner_.x, y = place.y - 0.5 - corner_.y;
    if (!(x > -cutout && y > -cutout && x < grid_.width() && y < grid_.height())) return {nullptr, 0, 0};
    const double column = std::floor(x), line = std::floor(y);
    return {from_corner(int(column), int(line)), float(x - column), float(y - line)};
}

} // namespace sparselens
