// The thin lens: how depth becomes blur, and how views are displaced.
//
// Depth z is planar, in scene units, in (0, inf]; z = inf is the sky. Lengths in the picture are in pixels, y down.
// A lens point u lies in the unit disc, u.y up. docs/design.md section 1 derives the formulas from similar triangles.
#pragma once

#include "../kernels/surface.h"

#include <Imath/ImathVec.h>

namespace sparselens {

struct ThinLens {
    double radius = 0;       // aperture radius, scene units, [0, inf)
    double focal_px = 1;     // focal length in pixels, (0, inf)
    double focus = 1;        // focus distance, scene units, (0, inf]
    double pixel_aspect = 1; // width over height of a pixel; offsets in y are multiplied by it
};

// Perceptive depth, the disparity R F / z, in pixels: 0 at infinity. The difference of two perceptive depths is the
// difference of their circles of confusion (CoC) at any focus distance, so an LDI that is clustered by it can still
// be refocused.
double perceptive_depth(const ThinLens &lens, double z);

// The signed CoC radius in pixels, negative in front of the focus. Never NaN for z and focus in (0, inf].
double circle_of_confusion(const ThinLens &lens, double z);

// Where lens point u sees a point of CoC c that the centre view shows at p.
inline Imath::V2d seen_through(const ThinLens &lens, const Imath::V2d &p, double c, const Imath::V2d &u) {
    return {p.x + c * u.x, p.y - c * u.y * lens.pixel_aspect};
}

// Where the centre view shows a point of depth z that a view from lens point u (with a parallel axis) shows at q.
Imath::V2d seen_from_centre(const ThinLens &lens, const Imath::V2d &q, double z, const Imath::V2d &u);

} // namespace sparselens
