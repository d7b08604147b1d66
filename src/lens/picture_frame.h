// The optical axis in a picture, and places measured from it.
#pragma once

#include "base/image.h"
#include "lens/lens_looks.h"

#include <cmath>

namespace sparselens {

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

} // namespace sparselens
