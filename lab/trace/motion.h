// Rigid motion of objects and of the camera while the shutter is open, at times from 0 (it opens) to 1 (it closes).
#pragma once

#include <Imath/ImathVec.h>

#include <vector>

namespace sparselens::lab {

struct Motion {
    // Displacements at equal distances of time, linear between them. Empty: none.
    std::vector<Imath::V3d> path = {};
    // Radians in all, evenly over the time, from x to y if the axis is z. In the middle, nothing is turned.
    double turn = 0;
    Imath::V3d pivot{0, 0, 0}; // a point of the axis, before the displacement
    Imath::V3d axis{0, 0, 1};  // of unit length

    bool moves() const { return !path.empty() || turn != 0; }
};

// The same motion, displaced by `by` all the time.
Motion displaced(Motion motion, const Imath::V3d &by);

// Where a thing that was modelled at rest stands at a time.
class Placement {
public:
    Placement(const Motion &motion, double time);

    Imath::V3d point(const Imath::V3d &at_rest) const;
    Imath::V3d direction(const Imath::V3d &at_rest) const { return turned(at_rest, sine_); }

    // The inverse.
    Imath::V3d point_at_rest(const Imath::V3d &point) const;
    Imath::V3d direction_at_rest(const Imath::V3d &direction) const { return turned(direction, -sine_); }

private:
    Imath::V3d turned(const Imath::V3d &v, double sine) const;

    Imath::V3d pivot_, axis_, shift_{0, 0, 0};
    double cosine_, sine_;
};

// When the shutter opens and closes; the same time twice is an instant.
struct Exposure {
    double opens = 0.5, closes = 0.5;

    bool instant() const { return opens == closes; }
    double middle() const { return at(0.5); }
    // `share`: of the time that it is open, [0, 1].
    double at(double share) const { return opens + share * (closes - opens); }
};

inline constexpr Exposure whole_shutter{0, 1};

// The middle of part k of `count` equal parts of the whole shutter.
constexpr Exposure moment_of(int k, int count) {
    const double time = (k + 0.5) / count;
    return {time, time};
}

} // namespace sparselens::lab
