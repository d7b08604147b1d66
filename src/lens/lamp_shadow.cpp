#include "lens/lamp_shadow.h"

#include <algorithm>
#include <array>
#include <bit>

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

float LampShadow::lit(int x, int y, const LampDisc *disc, const LampShadow *other) const {
    const std::size_t i = at(x, y);
    const std::uint64_t hidden = hidden_[i] | (other ? other->hidden_[i] : 0);
    const float veil = veil_[i] * (other ? other->veil_[i] : 1);
    const bool crossed = disc && hidden != 0 && ~hidden != 0 && !disc->contains_pixel(x, y);
    return veil * (crossed ? lit_points(hidden, x, y, *disc)
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

} // namespace sparselens
