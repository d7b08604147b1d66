// Shadows in the disc of a small lamp, cast by samples in front of the lamp.
//
// A lamp at x, of CoC c, lights the position q of the picture through lens point u = (q - x) / c. Through that lens
// point, a sample at x', of CoC c', is seen at x' + c' u, and hides the lamp at q if q lies there. So its shadow in the
// disc is the sample itself, magnified m = c / (c - c') times about the lamp: q = x + m (x' - x). Both axes have the
// same m, whatever the pixel aspect. Positions are EXR pixel coordinates, y down.
#pragma once

#include "base/numbers.h"
#include "lens/aperture.h"
#include "lens/lamp_spread.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <vector>

namespace sparselens {

// c and c' in pixels, signed and different. `scale`: the factor on (x' - x) / (c - c'); in the picture, c.
template <typename Number>
Number shadow_magnification(Number lamp_coc, Number coc, Number scale) {
    return scale / (lamp_coc - coc);
}
template <typename Number>
Number shadow_magnification(Number lamp_coc, Number coc) {
    return shadow_magnification(lamp_coc, coc, lamp_coc);
}

struct LampDisc {
    Imath::V2d centre, radius;
    bool contains(double x, double y) const {
        const double u = (x - centre.x) / radius.x, v = (y - centre.y) / radius.y;
        return u * u + v * v <= 1;
    }
    // All pixels of a box.
    bool contains_pixels(const Imath::Box2i &box) const {
        return contains(box.min.x, box.min.y) && contains(box.max.x + 1, box.min.y) &&
               contains(box.min.x, box.max.y + 1) && contains(box.max.x + 1, box.max.y + 1);
    }
    bool contains_pixel(int x, int y) const { return contains_pixels({{x, y}, {x, y}}); }
};

// The share of each pixel of a box that is in shadow, by 64 points in each pixel. No two points share a row or a
// column, so that an edge that crosses a pixel along an axis hides one point after the other.
class LampShadow {
public:
    // Begins with nothing hidden. Rectangles and pixels below have the origin of the box. `fine`: pixels are so small
    // that a thing that hides a share of the light may hide that share evenly over a pixel.
    void begin(const Imath::Box2i &box, bool fine = false);

    // Adds the shadow of a thing that covers a rectangle and hides a share `alpha` of the light, (0, 1].
    void hide(const Imath::Box2f &rectangle, float alpha, std::uint32_t thing);

    // Adds the shadows of `other`, moved by whole pixels. Its box, moved, must cover this box.
    void add(const LampShadow &other, const Imath::V2i &moved);

    // Whether all of the box is hidden.
    bool dark() const { return lit_pixels_ == 0; }

    // Whether some points of a pixel are hidden, and others are not.
    bool is_crossed(int x, int y) const {
        const std::uint64_t hidden = hidden_[at(x, y)];
        return hidden != 0 && ~hidden != 0;
    }

    // The share of a pixel of the box that is not hidden: of the whole pixel, or of its part that lies in a disc.
    float lit(int x, int y, const LampDisc *disc = nullptr) const;

private:
    std::size_t at(int x, int y) const {
        return std::size_t(y - box_.min.y) * width_ + std::size_t(x - box_.min.x);
    }

    Imath::Box2i box_;
    std::size_t width_ = 0;
    float thin_ = 0; // a thing that hides less is a veil over all that it covers of a pixel
    std::vector<std::uint64_t> hidden_; // [pixel]: a bit for each point
    std::size_t lit_pixels_ = 0;        // pixels of which some point is not hidden
    std::vector<float> veil_;           // [pixel]: the share that thin things let through
};

// The light of a small lamp that is hardly out of focus: its disc is a few pixels wide, or lies within one.
//
// The square around the aperture's picture is cut into cells, which scale with the CoC. Each cell gives its share of
// the light to the pixels in which it lies, less the hidden part (its shadows, cast on the cells). So nothing changes
// in steps of whole pixels or lens points, and a lamp that crosses the focus shrinks to a point and grows again.

// The light of a lamp in the pixels of a box, [row][column]: shares of R, G and B, and their mean.
struct LampLight {
    Imath::Box2i box;
    std::vector<Float4> whole, lit; // without shadows; with shadows

    std::size_t at(int x, int y) const {
        return std::size_t(y - box.min.y) * (std::size_t(box.max.x - box.min.x) + 1) +
               std::size_t(x - box.min.x);
    }
    // The share of a pixel's light that is not hidden.
    float lit_share(int x, int y) const {
        const std::size_t i = at(x, y);
        return whole[i][3] > 0 ? lit[i][3] / whole[i][3] : 1;
    }
};

class LampCells {
public:
    static constexpr int side = 32;
    static Imath::Box2i box() { return {{0, 0}, Imath::V2i(side - 1)}; }

    // `behind`: for lamps that are not in front of focus. The shares of each colour sum to 1, unless a cat-eye cuts.
    LampCells(const Aperture &aperture, bool behind, const LampCut *cut = nullptr);

    // How shadows are cast on the cells: the middle of the cells, and the factor on (x' - x) / (c - c').
    static Imath::V2d middle() { return Imath::V2d(side / 2.0); }
    Imath::V2d shadow_scale(double pixel_aspect) const { return {scale_, scale_ / pixel_aspect}; }

    // The size of a cell, pixels.
    Imath::V2d size(const Lamp &lamp) const;

    // The light of a lamp in the pixels of a box. It comes evenly from a square of width `square` around the lamp.
    // `shadow`: null if nothing is in shadow.
    LampLight shine(const Lamp &lamp, double square, const LampShadow *shadow, const Imath::Box2i &box) const;

private:
    LampLight shine_skewed(const Lamp &lamp, double square, const LampShadow *shadow,
                           const Imath::Box2i &box) const;

    std::array<Float4, std::size_t(side) * side> share_; // [row][column]
    double scale_; // cells per unit of the lens, with the sign of the CoC
};

} // namespace sparselens
