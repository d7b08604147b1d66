#include "looks/breathing.h"

#include "base/error.h"

#include <cmath>

namespace sparselens::looks {

void Breathing::act(const LookContext &context, LensLooks &looks) const {
    if (breathing.value_or(0) == 0) return;
    const double focal = focal_length_for("breathing", context) / 1000 / context.metres_per_unit;
    if (!(context.lens.focus > focal))
        throw UsageError(
            "`breathing`: the focus distance must exceed the focal length: no lens focuses nearer");
    looks.magnification = std::pow(unit_focusing_magnification(focal, context.lens.focus), *breathing);
}

} // namespace sparselens::looks
