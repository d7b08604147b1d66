#include "lens/f_number.h"

#include <limits>

namespace sparselens {

double radius_of(double fstop, double focal_mm, double metres_per_unit) {
    return focal_mm / 1000 / (2 * fstop) / metres_per_unit;
}

double fstop_of(double radius, double focal_mm, double metres_per_unit) {
    if (radius == 0) return std::numeric_limits<double>::infinity();
    return focal_mm / 1000 / (2 * radius) / metres_per_unit;
}

} // namespace sparselens
