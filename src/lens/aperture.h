// The aperture, prepared. The gather's lens points, the ray tracer's rays and the discs of small lamps all come from
// it. Places on the lens are u, x right and y up, in units of the radius of the f-number.
#pragma once

#include "lens/lens_looks.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace sparselens {

// A picture of an aperture, prepared for lookups: how much of its light lies in a rectangle, and the place before which
// a given share of its light lies. It is cropped to its content. Places are those of ApertureShape, before squeezing.

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

// Factors on the light of R, G and B.
using ColourFactors = std::array<float, 3>;
inline constexpr ColourFactors no_factors{1, 1, 1};

// A point of the lens. Its light is weighted by rgb, times `behind` or `in_front` depending on where the light comes
// from; the mean of each weight over the lens is 1. Coverage has no weight by rgb, and the weight of G by side.
struct LensPoint {
    Imath::V2d u;
    ColourFactors rgb = no_factors, behind = no_factors, in_front = no_factors;

    double side(bool is_behind, std::size_t colour) const {
        return double((is_behind ? behind : in_front)[colour]);
    }
};

class Aperture {
public:
    // Throws Error if no light passes in a channel of the picture.
    explicit Aperture(const ApertureShape &shape = {});

    const ApertureShape &shape() const { return shape_; }
    bool disc() const { return !picture_ && !two_sided() && round(); } // evenly bright, possibly squeezed
    bool coloured() const { return coloured_rims() || (picture_ && picture_->coloured()); }
    bool coloured_rims() const { return !shape_.spherical.even(); }
    bool two_sided() const { return shape_.spherical != ByColour(0); } // differs behind focus and in front
    Imath::V2d half_extent() const;                                    // the largest |u.x| and |u.y|

    // The lens point for a point of the unit square. Equal areas of the square pass equal light (the mean of R, G and
    // B, without the weights by side). x is the share of the light within a radius, y the share of a turn; for a
    // picture, x and y are rows and columns.
    LensPoint at(const Imath::V2d &square) const;

    // The outline before it is squeezed (ApertureShape); not for a picture. It is fine enough for discs of a CoC of
    // `coc` pixels: the light in a pixel is off by less than 1e-3 of the light of a pixel within the disc.
    std::vector<Imath::V2d> outline(double coc) const;

    // The table of an aperture picture, for light from behind focus or in front; null for other apertures.
    const PictureTable *picture(bool behind) const;

    // The weight of a colour's light from behind focus or in front, at a radius; the mean over the lens is 1. Up to a
    // radius of 1 it is linear in the square of the radius.
    double weight(bool behind, double square_radius, std::size_t colour = 1) const;

private:
    bool round() const { return shape_.blades == 0 || shape_.curvature == 1; }
    double signed_weight(bool behind, double square_radius, std::size_t colour) const;
    ColourFactors factors(bool behind, double square_radius) const;
    Imath::V2d place(const Imath::V2d &square) const;

    ApertureShape shape_;
    std::optional<PictureTable> picture_, behind_, in_front_;
    static constexpr int levels = 9; // of outlines, each for four times the CoC of the previous one
    std::array<std::vector<Imath::V2d>, levels> outlines_;
    std::vector<Imath::V2d> fan_;   // an outline, for points
    std::vector<double> fan_areas_; // of its triangles with the middle, summed up; the last is 1
    std::array<double, 3> mean_behind_{1, 1, 1}, mean_in_front_{1, 1, 1};
};

} // namespace sparselens
