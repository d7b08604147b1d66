// Between which depths a lens is sharp: where no circle of confusion (CoC) is larger than one that still counts as sharp.
//
// |c(z)| <= s, with c(z) = R F (z - d) / (d z) as in thin_lens.h, holds from R F d / (R F + s d) to R F d / (R F - s d); the
// second is infinite where s d >= R F, which the nearest focus distance of is R F / s: the hyperfocal distance.
#pragma once

#include "thin_lens.h"

namespace sparselens {

struct SharpRange {
    double near, far;  // depths, scene units, (0, inf]
    double hyperfocal; // focus distance, scene units, [0, inf)
};

// `sharp`: the largest CoC radius that is sharp, pixels, above 0.
SharpRange sharp_range(const ThinLens &lens, double sharp);

// The other way round: the focus, and the hyperfocal distance, of the widest lens that is sharp from `near` to `far`, 0 < near
// <= far; the distance is infinite where they are equal. It is as the radius of the aperture is.
struct FocusFor {
    double focus, hyperfocal;
};
FocusFor focus_for(double near, double far);

} // namespace sparselens
