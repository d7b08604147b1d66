#include "warp/images/matched_view.h"

#include "base/subpixels.h"
#include "kernels/warp_rules.h"
#include "lens/thin_lens.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

    // Smooths by (1, 2, 1) / 4 along both axes. Values between pixels are then about as noisy as values on pixels, and
    // a step of half a pixel follows the texture.
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

    // Keeps the depth of a pixel if it and all pixels around it show one surface; else sets NaN.
    void keep_one_surface(const float *from, float *to) const {
        for (int y = 0; y < side; ++y) {
            const float *own = from + around(0, y);
            float *out = to + at(0, y);
            std::copy_n(own, side, out);
            for (int v = y - 1; v <= y + 1; ++v)
                for (int u = -1; u <= 1; ++u) {
                    const float *other = from + around(u, v);
                    for (int x = 0; x < side; ++x)
                        out[x] = kernels::is_one_surface(other[x], own[x], one_mirror_px) ? out[x] : unknown;
                }
        }
    }
};

// Reads a line of pixels from `first` to the right. read(index, values) gives those inside; pixels outside repeat the
// nearest one.
template <typename Read>
void read_line(const Windows &windows, const Imath::V2i &first, std::span<float> out, const Read &read) {
    const Imath::Box2i &frame = windows.data;
    const int count = int(out.size()), y = std::clamp(first.y, frame.min.y, frame.max.y);
    const int begin = std::clamp(frame.min.x - first.x, 0, count - 1),
              end = std::clamp(frame.max.x + 1 - first.x, begin + 1, count);
    const int x = std::clamp(first.x + begin, frame.min.x, frame.max.x);
    read(windows.index(Imath::V2i(x, y)), out.subspan(std::size_t(begin), std::size_t(end - begin)));
    std::fill_n(out.begin(), begin, out[std::size_t(begin)]);
    std::fill(out.begin() + end, out.end(), out[std::size_t(end - 1)]);
}

} // namespace

MatchedView::MatchedView(const PlacedView &view, double scale, int across)
    : view_(view), across_(across), scale_(scale / across), rgb_(find_rgb(view.samples->channels)),
      grid_(reduced(view.samples->windows.data, across)), corner_(grid_.box().min) {
    columns_ = std::size_t(pieces_of(grid_.width() + cutout, tile_side));
    count_ = columns_ * std::size_t(pieces_of(grid_.height() + cutout, tile_side));
    tiles_ = std::make_unique<Tile[]>(count_);
}

void MatchedView::forget_unused() {
    for (Tile &tile : std::span(tiles_.get(), count_))
        if (!tile.is_used.exchange(false) && !tile.planes.empty())
            spare_->planes.push_back(std::exchange(tile.planes, {}));
}

std::size_t MatchedView::bytes() const {
    const std::span<const Tile> tiles(tiles_.get(), count_);
    const auto made = std::ranges::count_if(tiles, [](const Tile &tile) { return !tile.planes.empty(); });
    return std::size_t(made) * tile_bytes;
}

float MatchedView::depth(int x, int y) const {
    if (!contains(Imath::V2i(x, y))) return unknown;
    if (across_ == 1) {
        const std::size_t pixel = grid_.index(Imath::V2i(x, y));
        if (!view_.samples->is_single(pixel)) return unknown;
        return float(disparity(scale_, double(view_.samples->z(view_.samples->pixel(pixel).front()))));
    }
    float depth = unknown;
    depths_of({x, y}, std::span(&depth, 1));
    return depth;
}

void MatchedView::colours_of(std::size_t k, const Imath::V2i &first, std::span<float> out) const {
    const ViewSamples &view = *view_.samples;
    const auto side = std::size_t(across_);
    std::vector<float> line(out.size() * side);
    std::ranges::fill(out, 0.0f);
    for (int v = 0; v < across_; ++v) {
        read_line(view.windows, first * across_ + Imath::V2i(0, v), std::span(line),
                  [&](std::size_t i, std::span<float> values) { view.front_values(rgb_[k], i, values); });
        for (float &value : line) value = kernels::bounded(value);
        for (std::size_t x = 0; x < out.size(); ++x)
            for (std::size_t u = 0; u < side; ++u) out[x] += line[x * side + u];
    }
    if (across_ > 1)
        for (float &value : out) value /= float(across_ * across_);
}

// The mean depth of several pixels of the view, if they show one surface.
void MatchedView::depths_of(const Imath::V2i &first, std::span<float> out) const {
    const ViewSamples &view = *view_.samples;
    const auto side = std::size_t(across_);
    std::vector<float> line(out.size() * side), firsts;
    for (int v = 0; v < across_; ++v) {
        read_line(view.windows, first * across_ + Imath::V2i(0, v), std::span(line),
                  [&](std::size_t i, std::span<float> values) { view.single_depths(i, values); });
        for (float &depth : line) depth = float(disparity(scale_, double(depth)));
        if (across_ == 1) return void(std::ranges::copy(line, out.begin()));
        if (v == 0) {
            for (std::size_t x = 0; x < out.size(); ++x) firsts.push_back(line[x * side]);
            std::ranges::fill(out, 0.0f);
        }
        for (std::size_t x = 0; x < out.size(); ++x)
            for (std::size_t u = 0; u < side; ++u) {
                const float depth = line[x * side + u];
                out[x] += kernels::is_one_surface(depth, firsts[x], one_mirror_px) ? depth : unknown;
            }
    }
    for (float &depth : out) depth /= float(across_ * across_);
}

void MatchedView::use(std::size_t number) const {
    Tile &tile = tiles_[number];
    const std::scoped_lock lock(tile.making);
    if (tile.planes.empty()) make(number);
    tile.is_used.store(true, std::memory_order_release);
}

void MatchedView::make(std::size_t tile) const {
    constexpr Square square{row};
    constexpr auto wide = std::size_t(row + 2), size = wide * wide, out_size = std::size_t(plane);
    const Imath::V2i at(int(tile % columns_), int(tile / columns_));
    const Imath::V2i first = corner_ + at * tile_side - Imath::V2i(cutout + 1);
    std::vector<float> sharp(4 * size);
    const auto line = [&](std::size_t k, int y) {
        return std::span(sharp).subspan(k * size + std::size_t(y) * wide, wide);
    };
    for (int y = 0; y < row + 2; ++y) {
        const Imath::V2i from = first + Imath::V2i(0, y);
        for (std::size_t k = 0; k < 3; ++k)
            if (rgb_[k] != npos) colours_of(k, from, line(k, y));
        depths_of(from, line(3, y));
        for (int x = 0; x < row + 2; ++x)
            if (!contains(from + Imath::V2i(x, 0))) line(3, y)[std::size_t(x)] = unknown;
    }
    std::vector<float> &planes = tiles_[tile].planes;
    {
        const std::scoped_lock lock(spare_->taking);
        if (!spare_->planes.empty()) {
            planes = std::move(spare_->planes.back());
            spare_->planes.pop_back();
        }
    }
    planes.resize(4 * out_size);
    for (std::size_t k = 0; k < 3; ++k) square.smooth(&sharp[k * size], &planes[k * out_size]);
    square.keep_one_surface(&sharp[3 * size], &planes[3 * out_size]);
}

MatchedView::Pixel MatchedView::at(int x, int y) const {
    const float *p = from_corner(x - corner_.x, y - corner_.y);
    return {p[0], p[plane], p[2 * plane], p[3 * plane]};
}

MatchedView::Cutout MatchedView::cut(const Imath::V2d &place) const {
    const double x = place.x - 0.5 - corner_.x, y = place.y - 0.5 - corner_.y;
    if (!(x > -cutout && y > -cutout && x < grid_.width() && y < grid_.height())) return {nullptr, 0, 0};
    const double column = std::floor(x), line = std::floor(y);
    return {from_corner(int(column), int(line)), float(x - column), float(y - line)};
}

} // namespace sparselens
