// The aperture, prepared. The gather's lens points, the ray tracer's rays and the discs of small lamps all come from
// it. Places on the lens are u, x right and y up, in units of the radius of the f-number.
#pragma once

#include "lens/aperture_shape.h"
#include "lens/picture_table.h"

#include <Imath/ImathVec.h>

#include <array>
#include <optional>
#include <vector>

namespace sparselens {

// Factors on the light of R, G and B; coverage has that of G.
using ColourFactors = std::array<float, 3>;
inline constexpr ColourFactors no_factors{1, 1, 1};

// A point of the lens. Its light is weighted by rgb, times `behind` or `in_front` depending on where the light comes
// from; the mean of each weight over the lens is 1. Coverage has no weight by rgb.
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

    // The weight of a colour's light that comes from behind or in front, at a radius; the mean over the lens is 1. It is
    // linear in the square of the radius.
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
