// The depths between which a lens is sharp: no circle of confusion (CoC) is larger than a limit that still counts as
// sharp.
//
// |c(z)| <= s, with c(z) = R F (z - d) / (d z) as in thin_lens.h, holds from R F d / (R F + s d) to
// R F d / (R F - s d). The second is infinite if s d >= R F. The nearest such focus distance, R F / s, is the
// hyperfocal distance.
#pragma once

#include "thin_lens.h"

namespace sparselens {

struct SharpRange {
    double near, far;  // depths, scene units, (0, inf]
    double hyperfocal; // focus distance, scene units, [0, inf)
};

// `sharp`: the largest CoC radius that is sharp, pixels, above 0.
SharpRange sharp_range(const ThinLens &lens, double sharp);

// The inverse: the focus and the hyperfocal distance of the widest lens that is sharp from `near` to `far`, with 0 <
// near <= far. The hyperfocal distance is infinite if they are equal. It is proportional to the radius of the aperture.
struct FocusFor {
    double focus, hyperfocal;
};
FocusFor focus_for(double near, double far);

} // namespace sparselens
