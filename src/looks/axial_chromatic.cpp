#include "looks/axial_chromatic.h"

#include "lens/f_number.h"

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

} // namespace sparselens::looks
