// The point spread function of a sample out of focus: its light is spread evenly over the disc of its circle of
// confusion and seen by square pixels (a box filter one pixel wide).
//
// The centre and the pixels are in EXR pixel coordinates, y down. The disc is an ellipse with the half axes `radius`
// and radius * pixel_aspect. The weight of a pixel is area(disc and pixel) / area(disc), the share of the light that
// falls into it. The weights of all pixels sum to 1. With a radius of 0, or below kernels::smallest_psf_radius, all
// light falls into the pixel that contains the centre.
#pragma once

#include "base/image.h"
#include "lens/focus_field.h"
#include "lens/lens_looks.h"
#include "lens/thin_lens.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <array>
#include <numbers>

namespace sparselens {

namespace kernels {
struct Band;
}

struct Psf {
    Imath::V2d centre;
    double radius = 0; // pixels; tested up to 1e4
    double pixel_aspect = 1;

    // The weight of a pixel that lies wholly in the disc.
    double whole_weight() const { return 1 / (std::numbers::pi * radius * radius) / pixel_aspect; }
};

// The share of the light that falls into a box (EXR pixel coordinates), in closed form; the error is below 1e-14.
double psf_share(const Psf &psf, const Imath::Box2d &box);

// The slow reference: the weight of pixel (x, y), in long double; the error is below 1e-9 of the area of a pixel.
double psf_weight(const Psf &psf, int x, int y);

// The fast form: the weights within a box, row by row. The error is below 1e-6 of the area of a pixel. The arc is cut
// where it crosses the edges of pixels; the area under each piece is a trapezoid and the segment between the arc and
// its chord. It takes one square root for each row and column of edges and for each piece.
class PsfRows {
public:
    static constexpr int max_size = 64;

    // The box must not be empty, and is at most max_size wide and high.
    PsfRows(const Psf &psf, const Imath::Box2i &box);

    // The rows of the box that the disc touches.
    int begin_row() const { return rows_.begin; }
    int end_row() const { return rows_.end; }

    struct Span {
        int begin = 0, end = 0; // columns
    };
    // The columns of the box that the disc touches in row y of [begin_row, end_row). Sets weights[x - box.min.x] for
    // these columns and leaves the others as they are.
    Span row(int y, double *weights) const;

private:
    using Table = std::array<double, max_size + 1>;
    Span columns_within(double distance) const;
    void add_band(const kernels::Band &band, double *weights) const;
    template <int Direction>
    void add_arc(const kernels::Band &band, int column, double *weights) const;

    Psf psf_;
    Imath::Box2i box_;
    bool point_;
    double area_to_weight_;
    Span rows_, columns_;
    // Half the chord of the disc along each edge between columns and between rows that the disc touches.
    Table height_, width_;
};

// How far the lens spreads light: the circle of confusion, with all changes by the looks.
//
// A bent or tilted plane of focus and axial chromatic aberration add to the CoC. The CoC is scaled by the width of the
// aperture (1 / S for a lens squeezed by S < 1), skewed by astigmatism, stretched where the plane is steep
// (focus_field.h), and magnified with the picture.
class LightReach {
public:
    // `windows`: the picture's.
    LightReach(const ThinLens &lens, const LensLooks &looks, const Windows &windows);

    // The reach in x and y, in pixels, of the sample that the ray through the middle of the lens shows at p (EXR
    // coordinates), before the picture is magnified. `coc`: the sample's CoC with a flat plane of focus.
    Imath::V2d at(const Imath::V2d &p, double coc) const;

    // The box in which the magnified picture may show the sample.
    Imath::Box2d box(const Imath::V2d &p, double coc) const;

    // The place, before magnification, of the point that the magnified picture shows at p.
    Imath::V2d shown_at(const Imath::V2d &p) const { return frame_.magnified(p, 1 / magnification_); }
    double magnification() const { return magnification_; }

private:
    PictureFrame frame_;
    FocusField field_;
    Imath::V2d extent_;                               // of the aperture, per pixel of CoC
    double least_chromatic_ = 0, most_chromatic_ = 0; // limits of the offsets of colours' CoC
    double magnification_;
};

} // namespace sparselens
