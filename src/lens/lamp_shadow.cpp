#include "lens/lamp_shadow.h"

#include "lens/focus_field.h"
#include "lens/psf.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sparselens {

namespace {

constexpr int points = 64; // in a pixel: point k lies in column k and in row reversed(k) of 64

constexpr int reversed(int k) {
    int r = 0;
    for (int bit = 0; bit < 6; ++bit) r |= ((k >> bit) & 1) << (5 - bit);
    return r;
}

// Bits of the first n columns, and of the first n rows.
using Prefixes = std::array<std::uint64_t, points + 1>;

constexpr Prefixes column_prefixes() {
    Prefixes prefixes{};
    for (int n = 1; n <= points; ++n) prefixes[std::size_t(n)] = ~std::uint64_t(0) >> (points - n);
    return prefixes;
}

constexpr Prefixes row_prefixes() {
    Prefixes prefixes{};
    for (int n = 1; n <= points; ++n)
        prefixes[std::size_t(n)] = prefixes[std::size_t(n - 1)] | std::uint64_t(1) << reversed(n - 1);
    return prefixes;
}

constexpr Prefixes of_columns = column_prefixes(), of_rows = row_prefixes();

// A sample that hides less counts as a veil over all that it covers of a pixel, because whole points would be too
// coarse for many veils behind each other.
constexpr float thin = 0.125f;

// Strides by which the points that hide a share of n / 64 of the light spread over the pixel's columns: each point lies
// one stride after the previous one. Odd strides visit all columns.
constexpr std::array<int, 8> strides{39, 25, 19, 45, 23, 37, 27, 41};

constexpr Prefixes share_prefixes(int stride) {
    Prefixes prefixes{};
    for (int n = 1; n <= points; ++n)
        prefixes[std::size_t(n)] = prefixes[std::size_t(n - 1)] | std::uint64_t(1)
                                                                      << ((n - 1) * stride % points);
    return prefixes;
}

constexpr std::array<Prefixes, strides.size()> of_shares = [] {
    std::array<Prefixes, strides.size()> all{};
    for (std::size_t k = 0; k < strides.size(); ++k) all[k] = share_prefixes(strides[k]);
    return all;
}();

// The hidden points differ from thing to thing, so that things behind each other hide independently.
std::uint64_t hidden_points(float alpha, std::uint32_t thing) {
    const std::uint32_t hash = thing * 2654435761u;
    return std::rotl(of_shares[hash >> 29][std::size_t(alpha * points + 0.5f)], int(hash >> 23 & 63));
}

// A part of a row or a column of pixels, in 64ths of a pixel from the box's edge.
struct Reach {
    int begin, end;
    Reach(float low, float high, int size)
        : begin(int(std::clamp(low, 0.0f, float(size)) * points + 0.5f)),
          end(int(std::clamp(high, 0.0f, float(size)) * points + 0.5f)) {}
    int first() const { return begin / points; }
    int last() const { return (end - 1) / points; }
    // The points of a pixel inside this part.
    std::uint64_t within(int pixel, const Prefixes &prefixes) const {
        const int from = std::max(begin - pixel * points, 0), to = std::min(end - pixel * points, points);
        return prefixes[std::size_t(to)] & ~prefixes[std::size_t(from)];
    }
};

// The lit share of a pixel's points in a disc; of all its points if none lies in the disc.
float lit_points(std::uint64_t hidden, int x, int y, const LampDisc &disc) {
    int inside = 0, lit_inside = 0;
    for (int k = 0; k < points; ++k)
        if (disc.contains(x + (k + 0.5) / points, y + (reversed(k) + 0.5) / points)) {
            ++inside;
            lit_inside += (hidden >> k & 1) == 0;
        }
    return inside > 0 ? float(lit_inside) / float(inside) : float(points - std::popcount(hidden)) / points;
}

} // namespace

void LampShadow::begin(const Imath::Box2i &box, bool fine) {
    box_ = box;
    thin_ = fine ? 1 : thin;
    width_ = std::size_t(box.max.x - box.min.x) + 1;
    const std::size_t pixels = width_ * (std::size_t(box.max.y - box.min.y) + 1);
    hidden_.assign(pixels, 0);
    lit_pixels_ = pixels;
    veil_.assign(pixels, 1);
}

void LampShadow::add(const LampShadow &other, const Imath::V2i &moved) {
    lit_pixels_ = 0;
    for (int y = box_.min.y; y <= box_.max.y; ++y) {
        const std::size_t from = other.at(box_.min.x - moved.x, y - moved.y), to = at(box_.min.x, y);
        for (std::size_t x = 0; x < width_; ++x) {
            hidden_[to + x] |= other.hidden_[from + x];
            veil_[to + x] *= other.veil_[from + x];
            lit_pixels_ += ~hidden_[to + x] != 0;
        }
    }
}

float LampShadow::lit(int x, int y, const LampDisc *disc) const {
    const std::uint64_t hidden = hidden_[at(x, y)];
    const bool crossed = disc && hidden != 0 && ~hidden != 0 && !disc->contains_pixel(x, y);
    return veil_[at(x, y)] * (crossed ? lit_points(hidden, x, y, *disc)
                                      : float(points - std::popcount(hidden)) * (1.0f / points));
}

void LampShadow::hide(const Imath::Box2f &rectangle, float alpha, std::uint32_t thing) {
    const Reach across(rectangle.min.x - float(box_.min.x), rectangle.max.x - float(box_.min.x),
                       box_.max.x - box_.min.x + 1),
        down(rectangle.min.y - float(box_.min.y), rectangle.max.y - float(box_.min.y),
             box_.max.y - box_.min.y + 1);
    if (across.begin >= across.end || down.begin >= down.end) return;
    const bool veil = alpha < thin_;
    const std::uint64_t hides = alpha >= 1 ? ~std::uint64_t(0) : veil ? 0 : hidden_points(alpha, thing);
    const int first = across.first(), last = across.last();
    for (int y = down.first(); y <= down.last(); ++y) {
        const std::uint64_t rows = down.within(y, of_rows);
        const std::size_t row = std::size_t(y) * width_;
        for (int x = first; x <= last; ++x) {
            const std::uint64_t hit = rows & across.within(x, of_columns);
            std::uint64_t &hidden = hidden_[row + std::size_t(x)];
            const std::uint64_t before = hidden;
            hidden |= hit & hides;
            lit_pixels_ -= std::size_t(~hidden == 0 && ~before != 0);
            if (veil)
                veil_[row + std::size_t(x)] *=
                    ~hit == 0 ? 1 - alpha : std::pow(1 - alpha, float(std::popcount(hit)) * (1.0f / points));
        }
    }
}

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
