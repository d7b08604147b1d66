#include "lens/thin_lens.h"

#include "kernels/coc_rules.h"

namespace sparselens {

double disparity(const ThinLens &lens, double z) { return lens.radius * lens.focal_px / z; }

double circle_of_confusion(const ThinLens &lens, double z) {
    return kernels::coc_of(lens.radius * lens.focal_px, lens.focus, std::isinf(lens.focus), z, std::isinf(z));
}

Imath::V2d seen_from_centre(const ThinLens &lens, const Imath::V2d &q, double z, const Imath::V2d &u) {
    const double parallax = disparity(lens, z);
    return {q.x + parallax * u.x, q.y - parallax * u.y * lens.pixel_aspect};
}

double radius_of(double fstop, double focal_mm, double metres_per_unit) {
    return focal_mm / 1000 / (2 * fstop) / metres_per_unit;
}

double fstop_of(double radius, double focal_mm, double metres_per_unit) {
    if (radius == 0) return std::numeric_limits<double>::infinity();
    return focal_mm / 1000 / (2 * radius) / metres_per_unit;
}

} // namespace sparselens
