// A plane of focus that is bent or tilted (LensLooks): how much the CoC differs from that of a flat plane, by place in
// the picture. The difference does not depend on depth, because c = R F (1/d - 1/z).
#pragma once

#include "base/image.h"
#include "lens/lens_looks.h"
#include "lens/thin_lens.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

// The optical axis in a picture, and places measured from it.
struct PictureFrame {
    Imath::V2d axis;          // EXR pixel coordinates
    double half_diagonal = 1; // of the display window, in widths of a pixel
    double pixel_aspect = 1;

    // The place of p from the axis, x right, y up, in widths of a pixel.
    Imath::V2d from_axis(const Imath::V2d &p) const { return {p.x - axis.x, (axis.y - p.y) / pixel_aspect}; }
    // The same in half diagonals.
    Imath::V2d place(const Imath::V2d &p) const { return from_axis(p) / half_diagonal; }
    // Where a picture that is magnified about the axis shows p. 1 / by inverts it.
    Imath::V2d magnified(const Imath::V2d &p, double by) const { return axis + (p - axis) * by; }
};

inline PictureFrame picture_frame(const Windows &windows, const LensLooks &looks) {
    const Imath::V2d low(windows.display.min),
        size = Imath::V2d(windows.display.max) + Imath::V2d(1, 1) - low;
    const double aspect = double(windows.pixel_aspect);
    return {low + size / 2 + looks.axis, 0.5 * std::hypot(size.x, size.y / aspect), aspect};
}

class FocusField {
public:
    FocusField(const LensLooks &looks, const ThinLens &lens, const PictureFrame &frame)
        : looks_(looks), frame_(frame), at_focus_(lens.radius * lens.focal_px / lens.focus),
          focal_px_(lens.focal_px) {}

    bool flat() const { return looks_.field_curvature == 0 && looks_.tilt == Imath::V2d(0, 0) && !skews(); }
    bool skews() const { return looks_.astigmatism != 0; }

    // The factor on 1/d at p; 1 on the axis.
    double factor(const Imath::V2d &p) const {
        const Imath::V2d q = frame_.from_axis(p), place = frame_.place(p);
        return (1 + looks_.field_curvature * place.dot(place)) * (1 + looks_.tilt.dot(q) / focal_px_);
    }

    // The CoC, in the magnified picture, of a sample at p whose CoC with a flat plane is `coc`; shown_at() says where
    // that picture shows it.
    double bent(double coc, const Imath::V2d &p) const {
        return looks_.magnification * (coc + coc_offset(p));
    }
    Imath::V2d shown_at(const Imath::V2d &p) const { return frame_.magnified(p, looks_.magnification); }
    bool moves() const { return looks_.magnification != 1; }

    // The skew s, x right and y up: lens point u displaces a point seen at p by skewed(s, u) more. So the CoC is |s|
    // larger along a line through the axis (magnified with the picture), and |s| smaller across it.
    Imath::V2d skew(const Imath::V2d &p) const {
        const Imath::V2d q = frame_.place(p);
        return looks_.magnification * looks_.astigmatism * at_focus_ *
               Imath::V2d(q.x * q.x - q.y * q.y, 2 * q.x * q.y);
    }

    // Added to the CoC of the sample that the ray through the middle of the lens shows at p, in pixels.
    double coc_offset(const Imath::V2d &p) const { return at_focus_ * (factor(p) - 1); }

    // The change of that offset from pixel to pixel.
    Imath::V2d coc_gradient(const Imath::V2d &p) const {
        const Imath::V2d x(0.5, 0), y(0, 0.5);
        return {coc_offset(p + x) - coc_offset(p - x), coc_offset(p + y) - coc_offset(p - y)};
    }

private:
    LensLooks looks_;
    PictureFrame frame_;
    double at_focus_; // R F / d
    double focal_px_;
};

// Lens point u, mirrored about the x axis, then turned and scaled by s: the product s u* of complex numbers.
inline Imath::V2d skewed(const Imath::V2d &s, const Imath::V2d &u) {
    return {s.x * u.x + s.y * u.y, s.y * u.x - s.x * u.y};
}

// A lens point displaces samples by u for each pixel of CoC. A sample at p in the centre view, with the CoC c there, is
// seen at x = p + (c + gradient (x - p)) u = p + c stretch(u) u. The stretch is limited to 10, because it has a pole.
inline double stretch(const Imath::V2d &coc_gradient, const Imath::V2d &u) {
    return 1 / std::max(0.1, 1 - coc_gradient.dot(u));
}

} // namespace sparselens
