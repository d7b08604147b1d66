#include "lens/thin_lens.h"

#include <cmath>

namespace sparselens {

double perceptive_depth(const ThinLens &lens, double z) { return lens.radius * lens.focal_px / z; }

double circle_of_confusion(const ThinLens &lens, double z) {
    const double rf = lens.radius * lens.focal_px;
    if (std::isinf(lens.focus)) return -rf / z;
    if (std::isinf(z)) return rf / lens.focus;
    // (z - d) / z, not 1/d - 1/z: the difference of two nearby depths is exact, that of their inverses is not.
    return (rf / lens.focus) * ((z - lens.focus) / z);
}

Imath::V2d seen_from_centre(const ThinLens &lens, const Imath::V2d &q, double z, const Imath::V2d &u) {
    const double parallax = perceptive_depth(lens, z);
    return {q.x + parallax * u.x, q.y - parallax * u.y * lens.pixel_aspect};
}

} // namespace sparselens
