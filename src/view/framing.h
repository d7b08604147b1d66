// How the framing of a view differs from that of the centre view. Their optical axes are parallel. By default both
// frame the scene alike, and the optical axis passes through the middle of the picture.
#pragma once

#include <Imath/ImathVec.h>

namespace sparselens {

struct Framing {
    double forward = 0; // how far it stands in front of the centre view's camera, scene units
    double zoom = 1;    // its focal length over the centre view's, (0, inf)
    // Where its optical axis meets the picture: see Camera::principal_point.
    Imath::V2d principal_point{0, 0};

    bool operator==(const Framing &) const = default;
};

} // namespace sparselens
