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

// The share of the light that falls into a box (EXR pixel coordinates), in closed form; error below 1e-14.
double psf_share(const Psf &psf, const Imath::Box2d &box);

// The slow reference: the weight of pixel (x, y), in long double; error below 1e-9 of a pixel's area.
double psf_weight(const Psf &psf, int x, int y);

// The fast form: the weights in one row of pixels after the other, within a box. Error below 1e-6 of a pixel's
// area. The arc is cut where it crosses edges of pixels; what lies under each piece is a trapezoid and the
// segment between arc and chord. Square roots are taken once for each row and column of edges and each piece.
class PsfRows {
public:
    static constexpr int max_size = 64;

    // The box is not empty, and at most max_size wide and high.
    PsfRows(const Psf &psf, const Imath::Box2i &box);

    // Rows of the box that the disc touches.
    int begin_row() const { return rows_.begin; }
    int end_row() const { return rows_.end; }

    struct Span {
        int begin = 0, end = 0; // columns
    };
    // The columns of the box that the disc touches in row y of [begin_row, end_row); weights[x - box.min.x] is
    // set for those and left alone elsewhere.
    Span row(int y, double *weights) const;

private:
    using Table = std::array<double, max_size + 1>;
    struct Band;
    Span columns_within(double distance) const;
    void add_band(const Band &band, double *weights) const;
    template <int Direction>
    void add_arc(const Band &band, int column, double *weights) const;

    Psf psf_;
    Imath::Box2i box_;
    bool point_;
    double area_to_weight_;
    Span rows_, columns_;
    // Half the chord of the disc along each edge between columns, and along each edge between rows, of those
    // that the disc touches.
    Table height_, width_;
};

} // namespace sparselens
