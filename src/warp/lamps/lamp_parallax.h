// Finds the depth of small lamps for which all views have the depth of what is behind. All views must show a lamp where
// its depth says that they do: if some did not, their light would stay at the wall, and be there twice.
#pragma once

#include "view/view_mapping.h"

#include <Imath/ImathVec.h>

#include <cmath>
#include <span>
#include <vector>

namespace sparselens {

// A lamp in front of everything around it.
struct KnownLamp {
    Imath::V2d place{0, 0}; // its middle
    double light = 0;
    double inverse_z = 0; // 0: not known
};

inline bool is_same_light(const KnownLamp &a, const KnownLamp &b) {
    return std::abs(a.light - b.light) <= 0.33 * b.light;
}

struct LampBeforeWall {
    KnownLamp lamp;    // its depth is not known
    double around = 0; // 1 / z of the nearest thing around
};

// Returns the lamps with their positions in the centre view. `lamps`: of each view by rows, 1000 at most, because more
// are noise. Depths whose inverses differ by less than `tolerance` are one surface. Lamps that may as well lie on what
// is around them are left out.
std::vector<KnownLamp> depths_by_parallax(std::span<const std::vector<LampBeforeWall>> lamps,
                                          std::span<const ViewMapping> mappings, double tolerance);

} // namespace sparselens
