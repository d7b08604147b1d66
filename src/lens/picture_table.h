// A picture of an aperture, prepared for lookups: how much of its light lies in any rectangle, and which place has a given
// share of the light before it. It is cropped to its own content. Places are those of ApertureShape, before squeezing.
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
    // `weigh` is how much the light at a place counts, at least 0. Throws Error where a channel has no light.
    PictureTable(const AperturePicture &picture, const std::function<double(const Imath::V2d &)> &weigh);

    bool coloured() const { return coloured_; }                    // R, G and B differ
    const Imath::V2d &half_extent() const { return half_extent_; } // of the content; 1 is the longer one

    // The share of the light of each colour that falls into a rectangle, as the box (x right, y up) says.
    LightOfColours share(const Imath::Box2d &box) const;

    // The place below whose row lies the share `s` of all light, and left of which lies the share `t` of the row's.
    Imath::V2d place(double s, double t) const;

    // Density of R, G and B at a place over that of their mean; 0 where there is no light.
    std::array<double, 3> colour(const Imath::V2d &place) const;

private:
    std::size_t index(std::size_t x, std::size_t y) const { return y * (std::size_t(width_) + 1) + x; }
    double mean_before(std::size_t x, std::size_t y) const { return sums_[index(x, y)][3]; }
    LightOfColours before(double x, double y) const; // in columns and rows

    int width_ = 0, height_ = 0; // of the content
    bool coloured_ = false;
    Imath::V2d half_extent_;
    // [height + 1][width + 1]: of what lies below and left; row 0 is the lowest
    std::vector<LightOfColours> sums_;
};

} // namespace sparselens
