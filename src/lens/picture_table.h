// A picture of an aperture, prepared for lookups: how much of its light lies in any rectangle, and at which place a
// given share of the light lies before it. It is cropped to its content. Places are those of ApertureShape, before
// squeezing.
#pragma once

#include "lens/aperture_shape.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <array>
#include <functional>
#include <vector>

namespace sparselens {

// Light of R, G and B, and their mean.
using LightOfColours = std::array<double, 4>;

class PictureTable {
public:
    // `weigh` returns the weight of a colour's light at a place, at least 0. Throws Error if a channel has no light.
    PictureTable(const AperturePicture &picture,
                 const std::function<double(const Imath::V2d &, std::size_t colour)> &weigh);

    bool coloured() const { return coloured_; }                    // whether R, G and B differ
    const Imath::V2d &half_extent() const { return half_extent_; } // of the content; the longer one is 1

    // The share of each colour's light that falls into a rectangle (x right, y up).
    LightOfColours share(const Imath::Box2d &box) const;

    // The place with the share `s` of all light in the rows below it, and the share `t` of its row's light left of it.
    Imath::V2d place(double s, double t) const;

    // The density of R, G and B at a place, divided by the density of their mean; 0 if there is no light.
    std::array<double, 3> colour(const Imath::V2d &place) const;

private:
    std::size_t index(std::size_t x, std::size_t y) const { return y * (std::size_t(width_) + 1) + x; }
    double mean_before(std::size_t x, std::size_t y) const { return sums_[index(x, y)][3]; }
    LightOfColours before(double x, double y) const; // in columns and rows

    int width_ = 0, height_ = 0; // of the content
    bool coloured_ = false;
    Imath::V2d half_extent_;
    // [height + 1][width + 1]: sums of the light below and left; row 0 is the lowest
    std::vector<LightOfColours> sums_;
};

} // namespace sparselens
