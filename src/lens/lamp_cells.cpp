#include "lens/lamp_cells.h"

#include "lens/focus_field.h"
#include "lens/psf.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

// How much of each cell of a row (or column) of cells lies in each pixel of a row (or column) of pixels.
class Overlaps {
public:
    // The cells begin at `first`, `step` apart, each `width` wide about its middle. Pixels [begin, end).
    Overlaps(double first, double step, double width, int begin, int end)
        : pixels_(std::size_t(end - begin)), share_(std::size_t(LampCells::side) * pixels_) {
        for (std::size_t i = 0; i < LampCells::side; ++i) {
            const double middle = first + (double(i) + 0.5) * step, low = middle - width / 2 - begin;
            const double high = low + width;
            const auto pixel = [&](double v) { return std::size_t(std::clamp(v, 0.0, double(pixels_))); };
            span_[i] = {pixel(std::floor(low)), pixel(std::floor(high) + 1)};
            for (std::size_t p = span_[i][0]; p < span_[i][1]; ++p)
                share_[i * pixels_ + p] =
                    float((std::min(high, double(p + 1)) - std::max(low, double(p))) / width);
        }
    }
    // Calls visit(pixel, share) for the pixels in which a cell lies.
    template <typename Visit>
    void for_each(std::size_t cell, const Visit &visit) const {
        for (std::size_t p = span_[cell][0]; p < span_[cell][1]; ++p) visit(p, share_[cell * pixels_ + p]);
    }

private:
    std::size_t pixels_;
    std::vector<float> share_;                                          // [cell][pixel]
    std::array<std::array<std::size_t, 2>, LampCells::side> span_ = {}; // pixels
};

} // namespace

LampCells::LampCells(const Aperture &aperture, bool behind, const LampCut *cut) : share_{} {
    const Imath::V2d extent = aperture.half_extent();
    scale_ = (behind ? 1 : -1) * (side / 2) / std::max(extent.x, extent.y);
    const auto set = [&](int x, int y, const Float4 &share) {
        share_[std::size_t(y) * side + std::size_t(x)] = share;
    };
    if (aperture.disc() && !cut) {
        const double squeeze = aperture.shape().squeeze;
        const PsfRows rows({middle(), std::abs(scale_) / squeeze, squeeze}, box());
        std::array<double, PsfRows::max_size + 1> weights;
        for (int y = rows.begin_row(); y < rows.end_row(); ++y) {
            const PsfRows::Span span = rows.row(y, weights.data());
            for (int x = span.begin; x < span.end; ++x) {
                const auto w = float(weights[std::size_t(x)]);
                set(x, y, Float4{w, w, w, w});
            }
        }
        return;
    }
    const LampSpread spread = spread_lamp(aperture, {middle(), scale_}, box(), cut);
    std::size_t i = 0;
    for (int y = spread.box.min.y; !spread.box.isEmpty() && y <= spread.box.max.y; ++y)
        for (int x = spread.box.min.x; x <= spread.box.max.x; ++x, ++i) {
            const auto mean = float(spread.weights[i]);
            if (!spread.coloured) {
                set(x, y, Float4{mean, mean, mean, mean});
                continue;
            }
            const std::array<double, 3> &c = spread.colours[i];
            set(x, y, Float4{float(c[0]), float(c[1]), float(c[2]), mean});
        }
}

Imath::V2d LampCells::size(const Lamp &lamp) const {
    const double across = std::abs(lamp.coc / scale_);
    return {across, across * lamp.pixel_aspect};
}

LampLight LampCells::shine(const Lamp &lamp, double square, const LampShadow *shadow,
                           const Imath::Box2i &box) const {
    if (lamp.skew != Imath::V2d(0, 0)) return shine_skewed(lamp, square, shadow, box);
    const Imath::V2d cell = size(lamp), first = lamp.centre - cell * middle();
    const Overlaps columns(first.x, cell.x, std::hypot(cell.x, square), box.min.x, box.max.x + 1),
        rows(first.y, cell.y, std::hypot(cell.y, square), box.min.y, box.max.y + 1);
    const auto width = std::size_t(box.max.x - box.min.x) + 1;
    const std::size_t pixels = width * (std::size_t(box.max.y - box.min.y) + 1);
    LampLight light{box, std::vector<Float4>(pixels, Float4{}), std::vector<Float4>(pixels, Float4{})};
    std::vector<Float4> whole(width), lit(width); // of a row of cells
    for (std::size_t j = 0; j < side; ++j) {
        std::ranges::fill(whole, Float4{});
        std::ranges::fill(lit, Float4{});
        for (std::size_t i = 0; i < side; ++i) {
            const Float4 share = share_[j * side + i];
            if (!(share[3] > 0)) continue;
            const Float4 left = share * (shadow ? shadow->lit(int(i), int(j)) : 1.0f);
            columns.for_each(i, [&](std::size_t x, float in_pixel) {
                whole[x] += in_pixel * share;
                lit[x] += in_pixel * left;
            });
        }
        rows.for_each(j, [&](std::size_t y, float in_pixel) {
            for (std::size_t x = 0; x < width; ++x) {
                light.whole[y * width + x] += in_pixel * whole[x];
                light.lit[y * width + x] += in_pixel * lit[x];
            }
        });
    }
    return light;
}

// Divides each cell into points, squares that are at most half a pixel apart.
LampLight LampCells::shine_skewed(const Lamp &lamp, double square, const LampShadow *shadow,
                                  const Imath::Box2i &box) const {
    const double step = 1 / std::abs(scale_), apart = (std::abs(lamp.coc) + lamp.skew.length()) * step;
    const int n = std::clamp(int(std::ceil(2 * apart * std::max(1.0, lamp.pixel_aspect))), 1, 64);
    const double side_of_point = std::hypot(apart / n, square), share_of_point = 1.0 / (n * n);
    const Imath::V2d pixels(Imath::V2d(box.max) + Imath::V2d(1) - Imath::V2d(box.min));
    const auto count = std::size_t(pixels.x * pixels.y);
    LampLight light{box, std::vector<Float4>(count, Float4{}), std::vector<Float4>(count, Float4{})};
    const auto add = [&](const Imath::V2d &at, const Float4 &whole, const Float4 &lit) {
        const Imath::V2d half = Imath::V2d(side_of_point) / 2, low = at - half, high = at + half;
        const auto common = [&](int axis, int pixel) {
            return std::max(0.0, std::min(high[axis], pixel + 1.0) - std::max(low[axis], double(pixel))) /
                   side_of_point;
        };
        const auto first = [&](int axis) {
            return int(std::max(std::floor(low[axis]), double(box.min[axis])));
        };
        const auto last = [&](int axis) {
            return int(std::min(std::floor(high[axis]), double(box.max[axis])));
        };
        for (int y = first(1); y <= last(1); ++y)
            for (int x = first(0); x <= last(0); ++x) {
                const auto share = float(share_of_point * common(0, x) * common(1, y));
                light.whole[light.at(x, y)] += share * whole;
                light.lit[light.at(x, y)] += share * lit;
            }
    };
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const Float4 share = share_[std::size_t(j) * side + std::size_t(i)];
            if (!(share[3] > 0)) continue;
            const Float4 lit = share * (shadow ? shadow->lit(i, j) : 1.0f);
            for (int k = 0; k < n * n; ++k) {
                const Imath::V2d cell(i + (k % n + 0.5) / n - side / 2.0, side / 2.0 - j - (k / n + 0.5) / n);
                const Imath::V2d u = cell / scale_, moved = lamp.coc * u + skewed(lamp.skew, u);
                add(lamp.centre + Imath::V2d(moved.x, -moved.y * lamp.pixel_aspect), share, lit);
            }
        }
    return light;
}

} // namespace sparselens
