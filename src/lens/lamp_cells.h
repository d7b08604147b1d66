// The light of a small lamp that is hardly out of focus: its disc is a few pixels wide, or lies within one.
//
// The square around the aperture's picture is cut into cells, which scale with the CoC. Each cell gives its share of
// the light to the pixels in which it lies, less the hidden part (lamp_shadow.h, cast on the cells). So nothing changes
// in steps of whole pixels or lens points, and a lamp that crosses the focus shrinks to a point and grows again.
#pragma once

#include "base/float4.h"
#include "lens/aperture.h"
#include "lens/lamp_shadow.h"
#include "lens/lamp_spread.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <array>
#include <optional>
#include <vector>

namespace sparselens {

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
