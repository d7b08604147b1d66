// The depth of small lamps of which all views have that of what is behind: all of them show one where its depth says that they do.
// If some did not, their light would stay at the wall, and be there twice.
#pragma once

#include "view/view_mapping.h"

#include <Imath/ImathVec.h>

#include <cmath>
#include <span>
#include <vector>

namespace sparselens {

// A lamp that stands before all that is around it.
struct KnownLamp {
    Imath::V2d place{0, 0}; // its middle
    double light = 0;
    double inverse_z = 0; // 0: not known
};

inline bool is_same_light(const KnownLamp &a, const KnownLamp &b) {
    return std::abs(a.light - b.light) <= 0.33 * b.light;
}

struct LampBeforeWall {
    KnownLamp lamp;    // of no known depth
    double around = 0; // 1 / z of the nearest that is around
};

// Where they are in the centre view. `lamps`: of each view by rows, 1000 at most, as more are noise. Depths whose inverses differ
// by less than `tolerance` are one surface. What may as well lie on what is around it is left out.
std::vector<KnownLamp> depths_by_parallax(std::span<const std::vector<LampBeforeWall>> lamps,
                                          std::span<const ViewMapping> mappings, double tolerance);

} // namespace sparselens
