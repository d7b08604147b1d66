#include "warp/images/matched_view.h"

#include "base/subpixels.h"
#include "kernels/photo_rules.h"
#include "lens/perceptive_depth.h"

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

float MatchedView::depth_in_view(int x, int y) const {
    const ViewSamples &view = *view_.samples;
    const SampleRange samples = view.pixel(view.windows.index(x, y));
    return samples.size() == 1 ? float(perceptive_depth(scale_, double(view.z(samples.front())))) : unknown;
}

// Of several pixels of the view, the mean, if they show one surface.
float MatchedView::depth(int x, int y) const {
    if (!contains(x, y)) return unknown;
    if (across_ == 1) return depth_in_view(x, y);
    float sum = 0, count = 0, first = unknown;
    const Imath::Box2i frame = view_.samples->windows.data, box = subpixels_in({{x, y}, {x, y}}, across_);
    for (int v = std::max(box.min.y, frame.min.y); v <= std::min(box.max.y, frame.max.y); ++v)
        for (int u = std::max(box.min.x, frame.min.x); u <= std::min(box.max.x, frame.max.x); ++u) {
            const float own = depth_in_view(u, v);
            if (count == 0) first = own;
            if (!kernels::is_one_surface(own, first, one_mirror_px)) return unknown;
            sum += own, count += 1;
        }
    return sum / count;
}

// What lies outside has the colours of the border.
void MatchedView::add_colours(const Imath::V2i &first, std::span<float> red, std::span<float> green,
                              std::span<float> blue) const {
    const ViewSamples &view = *view_.samples;
    const Imath::Box2i frame = view.windows.data;
    const std::span<float> out[] = {red, green, blue};
    const int y = std::clamp(first.y, frame.min.y, frame.max.y), count = int(red.size()) * across_;
    std::vector<float> values(std::size_t(count), 0.0f);
    for (std::size_t k = 0; k < 3; ++k) {
        if (rgb_[k] == npos) continue;
        for (int x = 0; x < count; ++x) {
            const int column = std::clamp(first.x + x, frame.min.x, frame.max.x);
            const SampleRange samples = view.pixel(view.windows.index(column, y));
            values[std::size_t(x)] = samples.empty() ? 0 : view.value(rgb_[k], samples.front());
        }
        for (float &value : values) value = kernels::bounded(value);
        for (int x = 0; x < count; ++x) out[k][std::size_t(x / across_)] += values[std::size_t(x)];
    }
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
        for (int v = 0; v < across_; ++v)
            add_colours(first * across_ + Imath::V2i(0, y * across_ + v), line(0, y), line(1, y), line(2, y));
        for (int x = 0; x < row + 2; ++x) line(3, y)[std::size_t(x)] = depth(first.x + x, first.y + y);
    }
    if (across_ > 1)
        for (float &colour : std::span(sharp).first(3 * size)) colour /= float(across_ * across_);
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
