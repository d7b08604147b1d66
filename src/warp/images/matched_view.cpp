#include "warp/images/matched_view.h"

#include "kernels/photo_rules.h"
#include "lens/perceptive_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

// Pixels by (1, 2, 1) / 4 along both axes: what lies between pixels is then about as noisy as what lies on them, and a step
// of half a pixel follows the texture. at(x, y) is a pixel; those beyond `frame` are as those on its border.
template <typename At>
MatchedView::Pixel smoothed(const Imath::Box2i &frame, int x, int y, const At &at) {
    const int above = std::max(y - 1, frame.min.y), below = std::min(y + 1, frame.max.y);
    const auto along_y = [&](int column, std::size_t k) {
        return 0.25f * (at(column, above)[k] + 2 * at(column, y)[k] + at(column, below)[k]);
    };
    const int left = std::max(x - 1, frame.min.x), right = std::min(x + 1, frame.max.x);
    MatchedView::Pixel result{};
    for (std::size_t k = 0; k < 3; ++k)
        result[k] = 0.25f * (along_y(left, k) + 2 * along_y(x, k) + along_y(right, k));
    return result;
}

// The depth of a pixel if it and all those around show one surface.
template <typename At>
float depth_of_one_surface(const Imath::Box2i &frame, int x, int y, const At &at) {
    if (x <= frame.min.x || x >= frame.max.x || y <= frame.min.y || y >= frame.max.y) return unknown;
    const float own = at(x, y)[3];
    for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u)
            if (!kernels::is_one_surface(at(u, v)[3], own, one_mirror_px)) return unknown;
    return own;
}

} // namespace

MatchedView::MatchedView(const PlacedView &view, double scale)
    : view_(view), scale_(scale), rgb_(find_rgb(view.samples->channels)), grid_(view.samples->windows.grid()),
      corner_(grid_.box().min) {
    const Tiles tiles(grid_.box(), tile_side);
    columns_ = std::size_t(tiles.columns());
    tiles_ = std::make_unique<Tile[]>(tiles.count());
}

float MatchedView::depth(int x, int y) const {
    if (!contains(x, y)) return unknown;
    const ViewSamples &view = *view_.samples;
    const SampleRange samples = view.pixel(grid_.index(x, y));
    return samples.size() == 1 ? float(perceptive_depth(scale_, double(view.z(samples.front())))) : unknown;
}

// As the view shows it, and its depth.
MatchedView::Pixel MatchedView::sharp(int x, int y) const {
    const ViewSamples &view = *view_.samples;
    const SampleRange samples = view.pixel(grid_.index(x, y));
    Pixel pixel{0, 0, 0, depth(x, y)};
    for (std::size_t k = 0; k < 3 && !samples.empty(); ++k)
        if (rgb_[k] != npos) pixel[k] = kernels::bounded(view.value(rgb_[k], samples.front()));
    return pixel;
}

void MatchedView::make(std::size_t tile) const {
    std::call_once(tiles_[tile].making, [&] {
        const Imath::Box2i frame = grid_.box();
        Imath::Box2i box = Tiles(frame, tile_side).box(tile);
        box.max = {std::min(box.max.x + 1, frame.max.x), std::min(box.max.y + 1, frame.max.y)};
        const Grid around(
            Imath::Box2i({std::max(box.min.x - 1, frame.min.x), std::max(box.min.y - 1, frame.min.y)},
                         {std::min(box.max.x + 1, frame.max.x), std::min(box.max.y + 1, frame.max.y)}));
        std::vector<Pixel> pixels(around.size());
        for (std::size_t i = 0; i < pixels.size(); ++i)
            pixels[i] = sharp(around.pixel(i).x, around.pixel(i).y);
        const auto at = [&](int x, int y) -> const Pixel & { return pixels[around.index(x, y)]; };
        std::vector<Pixel> &out = tiles_[tile].pixels;
        out.resize(std::size_t(stride) * std::size_t(stride));
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int x = box.min.x; x <= box.max.x; ++x) {
                Pixel &pixel =
                    out[std::size_t(y - box.min.y) * std::size_t(stride) + std::size_t(x - box.min.x)];
                pixel = smoothed(frame, x, y, at);
                pixel[3] = depth_of_one_surface(frame, x, y, at);
            }
        tiles_[tile].is_made.store(true, std::memory_order_release);
    });
}

bool MatchedView::at(const Imath::V2d &place, Pixel &out) const {
    const double x = place.x - 0.5 - corner_.x, y = place.y - 0.5 - corner_.y;
    if (!(x >= 0 && y >= 0 && x < grid_.width() - 1 && y < grid_.height() - 1)) return false;
    const int column = int(x), row = int(y);
    const float u = float(x - column), v = float(y - row);
    const Pixel *p = from_corner(column, row), *q = p + stride;
    for (std::size_t k = 0; k < 3; ++k) {
        const float upper = p[0][k] + u * (p[1][k] - p[0][k]), lower = q[0][k] + u * (q[1][k] - q[0][k]);
        out[k] = upper + v * (lower - upper);
    }
    out[3] = (v < 0.5f ? p : q)[u < 0.5f ? 0 : 1][3];
    return true;
}

} // namespace sparselens
