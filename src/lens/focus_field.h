// A plane of focus that is bent or tilted (LensLooks): how the CoC differs from that of the flat one, by place. It does not
// depend on depth, for c = R F (1/d - 1/z).
#pragma once

#include "lens/lens_looks.h"
#include "lens/picture_frame.h"
#include "lens/thin_lens.h"

#include <algorithm>

namespace sparselens {

class FocusField {
public:
    FocusField(const LensLooks &looks, const ThinLens &lens, const PictureFrame &frame)
        : looks_(looks), frame_(frame), at_focus_(lens.radius * lens.focal_px / lens.focus),
          focal_px_(lens.focal_px) {}

    bool flat() const { return looks_.field_curvature == 0 && looks_.tilt == Imath::V2d(0, 0) && !skews(); }
    bool skews() const { return looks_.astigmatism != 0; }

    // Factor on 1/d at p; 1 on the axis.
    double factor(const Imath::V2d &p) const {
        const Imath::V2d q = frame_.from_axis(p), place = frame_.place(p);
        return (1 + looks_.field_curvature * place.dot(place)) * (1 + looks_.tilt.dot(q) / focal_px_);
    }

    // The CoC, in the magnified picture, of what would have that one in a flat one; and where it is shown.
    double bent(double coc, const Imath::V2d &p) const {
        return looks_.magnification * (coc + coc_offset(p));
    }
    Imath::V2d shown_at(const Imath::V2d &p) const { return frame_.magnified(p, looks_.magnification); }
    bool moves() const { return looks_.magnification != 1; }

    // By s, x right and y up: lens point u displaces what is seen at p by s u* more, u* mirrored in x. So the CoC is |s| more
    // along a line through the axis (in a magnified picture, as much more), and |s| less across it.
    Imath::V2d skew(const Imath::V2d &p) const {
        const Imath::V2d q = frame_.place(p);
        return looks_.magnification * looks_.astigmatism * at_focus_ *
               Imath::V2d(q.x * q.x - q.y * q.y, 2 * q.x * q.y);
    }

    // Added to the CoC of the sample that the ray through the middle of the lens shows at p, pixels.
    double coc_offset(const Imath::V2d &p) const { return at_focus_ * (factor(p) - 1); }

    // Its change from pixel to pixel.
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

// Lens point u mirrored in x, turned and scaled by s.
inline Imath::V2d skewed(const Imath::V2d &s, const Imath::V2d &u) {
    return {s.x * u.x + s.y * u.y, s.y * u.x - s.x * u.y};
}

// A lens point displaces by u for each pixel of CoC. It sees a sample at p in the centre view, with the CoC c there, at
// x = p + (c + gradient (x - p)) u = p + c stretch(u) u. Beyond 1/10 of a fold nothing is stretched further.
inline double stretch(const Imath::V2d &coc_gradient, const Imath::V2d &u) {
    return 1 / std::max(0.1, 1 - coc_gradient.dot(u));
}

} // namespace sparselens
