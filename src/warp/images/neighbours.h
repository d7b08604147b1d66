// The pixels of a block and those around it, stored for the search for images, which reads them repeatedly from each
// pixel of the block.
#pragma once

#include "kernels/surface.h"

#include <Imath/ImathVec.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace sparselens {

inline constexpr int image_block = 8; // pixels wide and high

// Positions are relative to the upper left pixel of the block.
class Neighbours {
public:
    static constexpr int reach = 8; // pixels around the block

    struct Pixel {
        float own_depth; // perceptive, of its surface; NaN: it shows no surface that could be searched
        float depth;     // of its image; NaN: not known
    };
    template <typename PixelAt>
    explicit Neighbours(const PixelAt &pixel_at) {
        for (int y = -reach; y < image_block + reach; ++y)
            for (int x = -reach; x < image_block + reach; ++x)
                pixels_[at({x, y})] = pixel_at(Imath::V2i(x, y));
    }

    float depth(const Imath::V2i &place) const { return pixels_[at(place)].depth; }

    // Calls visit(offset, depth) for the pixels of the same surface within a distance, at most `reach`, including the
    // pixel itself.
    template <typename Visit>
    void for_each_around(const Imath::V2i &place, int distance, const Visit &visit) const {
        const float own = pixels_[at(place)].own_depth;
        for (int y = -distance; y <= distance; ++y) {
            const Pixel *row = &pixels_[at(place + Imath::V2i(0, y))];
            for (int x = -distance; x <= distance; ++x)
                if (kernels::is_one_surface(row[x].own_depth, own, one_mirror_px))
                    visit(Imath::V2i(x, y), row[x].depth);
        }
    }

private:
    static constexpr int side = image_block + 2 * reach;
    static std::size_t at(const Imath::V2i &place) {
        return std::size_t((place.y + reach) * side + place.x + reach);
    }
    std::array<Pixel, std::size_t(side) * side> pixels_;
};

// Fits a plane to values at positions, and gives its value at the origin; the mean of the values if the positions lie
// on a line.
class LinearFit {
public:
    void add(const Imath::V2d &p, double value) {
        n_ += 1, x_ += p.x, y_ += p.y, xx_ += p.x * p.x, xy_ += p.x * p.y, yy_ += p.y * p.y;
        v_ += value, vx_ += value * p.x, vy_ += value * p.y;
    }
    double count() const { return n_; }
    double at_origin() const {
        const double xx = xx_ - x_ * x_ / n_, xy = xy_ - x_ * y_ / n_, yy = yy_ - y_ * y_ / n_;
        const double vx = vx_ - v_ * x_ / n_, vy = vy_ - v_ * y_ / n_, det = xx * yy - xy * xy;
        if (!(det > 1e-6 * xx * yy)) return v_ / n_;
        return (v_ - x_ * (vx * yy - vy * xy) / det - y_ * (vy * xx - vx * xy) / det) / n_;
    }

private:
    double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0, v_ = 0, vx_ = 0, vy_ = 0;
};

} // namespace sparselens
