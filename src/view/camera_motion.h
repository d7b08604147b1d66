// How a camera's own motion moves the picture of things that stand still.
#pragma once

#include "../base/image.h"
#include "camera.h"

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <optional>

namespace sparselens {

class CameraMotion {
public:
    // Where `to` shows what `from` shows at p (pixels, EXR coordinates) at planar depth z, in (0, inf]. Not a number if
    // it lies behind that camera.
    Imath::V2d moved(const Imath::V2d &p, double z) const;

private:
    friend std::optional<CameraMotion> camera_motion(const Camera &, const Camera &, const Windows &);
    struct Pinhole {
        double focal;    // pixels
        double aspect;   // of a pixel
        Imath::V2d axis; // where it meets the picture, pixels
    };
    static std::optional<Pinhole> pinhole_of(const Camera &camera, const Windows &windows);

    Pinhole from_, to_;
    Imath::M44d between_; // from one camera's space to the other's
};

// Both pictures have the same display window. Empty if a matrix or a focal length is unknown.
std::optional<CameraMotion> camera_motion(const Camera &from, const Camera &to, const Windows &windows);

} // namespace sparselens
