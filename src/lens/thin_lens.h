// The thin lens: how depth becomes blur, and how views are displaced.
//
// Depth z is planar, in scene units, in (0, inf]; z = inf is the sky. Lengths in the picture are in pixels, y down.
// A lens point u lies in the unit disc, u.y up. docs/design.md section 1 derives the formulas from similar triangles.
#pragma once

#include "../kernels/surface.h"

#include <Imath/ImathVec.h>

#include <cmath>
#include <limits>

namespace sparselens {

struct ThinLens {
    double radius = 0;       // aperture radius, scene units, [0, inf)
    double focal_px = 1;     // focal length in pixels, (0, inf)
    double focus = 1;        // focus distance, scene units, (0, inf]
    double pixel_aspect = 1; // width over height of a pixel; offsets in y are multiplied by it
};

// The disparity R F / z, in pixels: 0 at infinity. The difference of two disparities is the difference of their circles
// of confusion (CoC) at any focus distance, so an LDI that is clustered by it can still be refocused.
double disparity(const ThinLens &lens, double z);

// The signed CoC radius in pixels, negative in front of the focus. Never NaN for z and focus in (0, inf].
double circle_of_confusion(const ThinLens &lens, double z);

// Where lens point u sees a point of CoC c that the centre view shows at p.
inline Imath::V2d seen_through(const ThinLens &lens, const Imath::V2d &p, double c, const Imath::V2d &u) {
    return {p.x + c * u.x, p.y - c * u.y * lens.pixel_aspect};
}

// Where the centre view shows a point of depth z that a view from lens point u (with a parallel axis) shows at q.
Imath::V2d seen_from_centre(const ThinLens &lens, const Imath::V2d &q, double z, const Imath::V2d &u);

// The f-number: the focal length over the diameter of the aperture.

// Radius of the aperture in scene units, [0, inf); 0 for an f-number of infinity. fstop in (0, inf], focal_mm and
// metres_per_unit (the length of a scene unit) in (0, inf).
double radius_of(double fstop, double focal_mm, double metres_per_unit = 1);

// The inverse: the f-number, infinity for a radius of 0.
double fstop_of(double radius, double focal_mm, double metres_per_unit = 1);

// Disparity R F / z, in pixels, from the lens's scale R F (pixels times scene units) alone, for code that
// compares depths and needs no focus. See also disparity(lens, z).
inline double disparity_scale(double radius, double focal_px) { return radius * focal_px; }

inline double disparity(double scale, double z) { return scale / z; }

// The inverse: the depth that has this disparity.
inline double depth_at_disparity(double scale, double disparity) { return scale / disparity; }

// The difference in 1 / z of two depths whose disparities differ by `disparity`.
inline double inverse_depth_step(double scale, double disparity) { return disparity / scale; }

// The depths between which a lens is sharp: no circle of confusion (CoC) is larger than a limit that still counts as
// sharp.
//
// |c(z)| <= s, with c(z) = R F (z - d) / (d z), holds from R F d / (R F + s d) to
// R F d / (R F - s d). The second is infinite if s d >= R F. The nearest such focus distance, R F / s, is the
// hyperfocal distance.
struct SharpRange {
    double near, far;  // depths, scene units: [0, inf) and (0, inf]
    double hyperfocal; // focus distance, scene units, [0, inf)
};

// `sharp`: the largest CoC radius that is sharp, pixels, above 0.
inline SharpRange sharp_range(const ThinLens &lens, double sharp) {
    const double scale = disparity_scale(lens.radius, lens.focal_px), hyperfocal = scale / sharp;
    if (std::isinf(lens.focus)) return {hyperfocal, lens.focus, hyperfocal};
    const double near = hyperfocal > 0 ? lens.focus / (1 + lens.focus / hyperfocal) : 0;
    const double far = lens.focus < hyperfocal ? lens.focus / (1 - lens.focus / hyperfocal)
                                               : std::numeric_limits<double>::infinity();
    return {near, far, hyperfocal};
}

// The inverse: the focus and the hyperfocal distance of the widest lens that is sharp from `near` to `far`, with 0 <
// near <= far. The hyperfocal distance is infinite if they are equal. It is proportional to the radius of the aperture.
struct FocusFor {
    double focus, hyperfocal;
};

inline FocusFor focus_for(double near, double far) {
    const double ratio = std::isinf(far) ? 0 : near / far;
    return {2 * near / (1 + ratio), 2 * near / (1 - ratio)};
}

} // namespace sparselens
