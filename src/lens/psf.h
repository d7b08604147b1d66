// The point spread function of a sample out of focus: its light spread evenly over the disc of its circle of
// confusion, seen by square-edged pixels (a box filter one pixel wide).
//
// Centre and pixels are in EXR pixel coordinates, y down; the disc is an ellipse, `radius` wide and
// radius * pixel_aspect high. The weight of a pixel is area(disc and pixel) / area(disc): the share of the
// light that falls into it. The weights of all pixels sum to 1. A radius of 0 is a point: all its light falls
// into the pixel that holds it.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <array>

namespace sparselens {

struct Psf {
    Imath::V2d centre;
    double radius = 0; // [0, 1e4] pixels are tested
    double pixel_aspect = 1;
};

// Below this radius a disc is taken for a point.
inline constexpr double smallest_psf_radius = 1e-9;

// The slow reference: the weight of pixel (x, y) in closed form. Error below 1e-9 of a pixel's area.
double psf_weight(const Psf &psf, int x, int y);

// The fast form: the weights in one row of pixels after the other, within a box. Error below 1e-6 of a
// pixel's area. Square roots are taken once for each row and column of pixel edges, none of the functions
// with a series of its own (asin) is called.
class PsfRows {
public:
    static constexpr int max_width = 64;

    // The box is not empty and at most max_width wide.
    PsfRows(const Psf &psf, const Imath::Box2i &box);

    // Rows of the box that the disc touches.
    int begin_row() const { return begin_row_; }
    int end_row() const { return end_row_; }

    struct Span {
        int begin, end; // columns
    };
    // The columns of the box that the disc touches in row y of [begin_row, end_row); weights[x - box.min.x]
    // is set for those and left alone elsewhere.
    Span row(int y, double *weights) const;

private:
    struct Band;
    Band band(double low, double high) const;
    double area_left_of(const Band &band, int edge) const;
    Span point_row(double *weights) const;

    Psf psf_;
    Imath::Box2i box_;
    double area_to_weight_;
    int begin_row_, end_row_;
    // Height of the disc above the row of its centre at each edge between columns of the box.
    std::array<double, max_width + 1> height_;
};

} // namespace sparselens
