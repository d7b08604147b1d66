#include "warp/images/matched_view.h"

#include "base/parallel.h"
#include "lens/perceptive_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

MatchedView::MatchedView(const PlacedView &view, double scale)
    : view_(view), grid_(view.samples->windows.grid()), pixels_(grid_.size()),
      depths_(grid_.size(), std::numeric_limits<float>::quiet_NaN()) {
    const Ldi &ldi = *view.samples;
    const auto rgb = find_rgb(ldi.channels);
    parallel_ranges(pixels_.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const SampleRange samples = ldi.pixel(i);
            Pixel &pixel = pixels_[i];
            pixel = {};
            if (samples.empty()) continue;
            if (samples.size() == 1)
                depths_[i] = float(perceptive_depth(scale, double(ldi.z[samples.front()])));
            for (std::size_t k = 0; k < 3; ++k)
                if (rgb[k] != npos) {
                    const float v = ldi.values[rgb[k]][samples.front()];
                    pixel[k] = v / (1 + std::abs(v));
                }
        }
    });
    smooth();
    mark_mixed();
}

void MatchedView::mark_mixed() {
    const int width = grid_.width(), height = grid_.height();
    parallel_for(std::size_t(height), [&](std::size_t row) {
        const std::size_t first = row * std::size_t(width);
        for (int x = 0; x < width; ++x) {
            const std::size_t i = first + std::size_t(x);
            bool alone = x > 0 && x + 1 < width && row > 0 && int(row) + 1 < height;
            for (std::size_t line = i - std::size_t(width), n = 0; alone && n < 3;
                 ++n, line += std::size_t(width))
                for (std::size_t k = line - 1; k <= line + 1; ++k)
                    alone = alone && std::abs(depths_[k] - depths_[i]) <= one_mirror_px;
            pixels_[i][3] = alone ? depths_[i] : std::numeric_limits<float>::quiet_NaN();
        }
    });
}

// By (1, 2, 1) / 4 along both axes: what lies between pixels is then about as noisy as what lies on them, and a step of
// half a pixel follows the texture.
void MatchedView::smooth() {
    const std::vector<Pixel> sharp = pixels_;
    const int width = grid_.width(), height = grid_.height();
    parallel_for(std::size_t(height), [&](std::size_t row) {
        const int y = int(row);
        std::vector<Pixel> line(static_cast<std::size_t>(width)); // smoothed along y
        const auto row_of = [&](int at) {
            return &sharp[std::size_t(std::clamp(at, 0, height - 1)) * std::size_t(width)];
        };
        const Pixel *above = row_of(y - 1), *own = row_of(y), *below = row_of(y + 1);
        for (std::size_t x = 0; x < line.size(); ++x)
            for (std::size_t k = 0; k < 3; ++k)
                line[x][k] = 0.25f * (above[x][k] + 2 * own[x][k] + below[x][k]);
        Pixel *out = &pixels_[row * std::size_t(width)];
        for (std::size_t x = 0; x < line.size(); ++x) {
            const Pixel &left = line[x > 0 ? x - 1 : x], &right = line[std::min(x + 1, line.size() - 1)];
            for (std::size_t k = 0; k < 3; ++k) out[x][k] = 0.25f * (left[k] + 2 * line[x][k] + right[k]);
        }
    });
}

bool MatchedView::at(const Imath::V2d &place, Pixel &out) const {
    const Imath::V2i corner = grid_.box().min;
    const double x = place.x - 0.5 - corner.x, y = place.y - 0.5 - corner.y;
    if (!(x >= 0 && y >= 0 && x < grid_.width() - 1 && y < grid_.height() - 1)) return false;
    const int column = int(x), row = int(y);
    const float u = float(x - column), v = float(y - row);
    const Pixel *p = &pixels_[std::size_t(row) * std::size_t(grid_.width()) + std::size_t(column)];
    const Pixel *q = p + grid_.width();
    for (std::size_t k = 0; k < 3; ++k) {
        const float upper = p[0][k] + u * (p[1][k] - p[0][k]), lower = q[0][k] + u * (q[1][k] - q[0][k]);
        out[k] = upper + v * (lower - upper);
    }
    out[3] = (v < 0.5f ? p : q)[u < 0.5f ? 0 : 1][3];
    return true;
}

} // namespace sparselens
