#include "looks/focus_looks.h"

#include "base/error.h"
#include "lens/thin_lens.h"

#include <cmath>

namespace sparselens::looks {

void AxialChromatic::act(const LookContext &context, LensLooks &looks) const {
    const double mm = axial_chromatic.value_or(0);
    const ThinLens &lens = context.lens;
    if (mm == 0 || lens.radius == 0) return;
    const double focal_mm = focal_length_for("axial_chromatic", context);
    const double coc =
        defocus_coc(mm, fstop_of(lens.radius, focal_mm, context.metres_per_unit), lens.focal_px / focal_mm);
    switch (chromatic_type.value_or(ChromaticType::red_blue)) {
    case ChromaticType::blue_yellow: looks.chromatic_coc = {0, 0, -coc}; break;
    case ChromaticType::green_magenta: looks.chromatic_coc = {coc, 0, coc}; break;
    case ChromaticType::red_blue: looks.chromatic_coc = {coc, 0, -coc}; break;
    }
}

void Breathing::act(const LookContext &context, LensLooks &looks) const {
    if (breathing.value_or(0) == 0) return;
    const double focal = focal_length_for("breathing", context) / 1000 / context.metres_per_unit;
    if (!(context.lens.focus > focal))
        throw UsageError(
            "`breathing`: the focus distance must exceed the focal length: no lens focuses nearer");
    looks.magnification = std::pow(unit_focusing_magnification(focal, context.lens.focus), *breathing);
}

} // namespace sparselens::looks
