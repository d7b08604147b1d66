// The thin lens: the only place that knows how depth becomes blur and how views are displaced.
//
// Depth z is planar, in scene units, in (0, inf]; z = inf is the sky. Lengths in the image are pixels, y down.
// A lens point u lies in the unit disc, u.y up. Formulas: design.md section 1, from similar triangles.
#pragma once

#include <Imath/ImathVec.h>

namespace sparselens {

struct ThinLens {
    double radius = 0;       // aperture radius, scene units, [0, inf)
    double focal_px = 1;     // focal length in pixels, (0, inf)
    double focus = 1;        // focus distance, scene units, (0, inf]
    double pixel_aspect = 1; // offsets in y are multiplied by it
};

// Perceptive depth R F / z, pixels: 0 at infinity. The difference of two is the difference of their CoC at any
// focus distance, which is why clustering by it keeps a picture refocusable.
double perceptive_depth(const ThinLens &lens, double z);

// Perceptive depths that differ by less, in pixels, count as one surface: seen from the rim of the lens the two move
// apart by less than half a pixel, so that pictures of both fall into the same pixels.
inline constexpr double one_surface_px = 0.5;

// Signed CoC radius in pixels: < 0 in front of focus. Never NaN for z and focus in (0, inf].
double circle_of_confusion(const ThinLens &lens, double z);

// Where a point of CoC c that the centre view shows at p lands when seen through lens point u.
inline Imath::V2d seen_through(const ThinLens &lens, const Imath::V2d &p, double c, const Imath::V2d &u) {
    return {p.x + c * u.x, p.y - c * u.y * lens.pixel_aspect};
}

// Where the centre view shows a point of depth z that a view from lens point u (parallel axes) shows at q.
Imath::V2d seen_from_centre(const ThinLens &lens, const Imath::V2d &q, double z, const Imath::V2d &u);

} // namespace sparselens
