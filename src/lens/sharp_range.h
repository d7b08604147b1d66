// The depths between which a lens is sharp: no circle of confusion (CoC) is larger than a limit that still counts as
// sharp.
//
// |c(z)| <= s, with c(z) = R F (z - d) / (d z) as in thin_lens.h, holds from R F d / (R F + s d) to
// R F d / (R F - s d). The second is infinite if s d >= R F. The nearest such focus distance, R F / s, is the
// hyperfocal distance.
#pragma once

#include "lens/perceptive_depth.h"
#include "thin_lens.h"

#include <cmath>
#include <limits>

namespace sparselens {

struct SharpRange {
    double near, far;  // depths, scene units, (0, inf]
    double hyperfocal; // focus distance, scene units, [0, inf)
};

// `sharp`: the largest CoC radius that is sharp, pixels, above 0.
inline SharpRange sharp_range(const ThinLens &lens, double sharp) {
    const double scale = perceptive_scale(lens.radius, lens.focal_px), hyperfocal = scale / sharp;
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
    const double ratio = near / far; // 0 if the range goes on to infinity
    return {2 * near / (1 + ratio), 2 * near / (1 - ratio)};
}

} // namespace sparselens
