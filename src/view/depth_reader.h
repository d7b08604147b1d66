// A picture's depth channel, made planar.
#pragma once

#include "base/image.h"
#include "view/camera.h"
#include "view/depth.h"

namespace sparselens {

class DepthReader {
public:
    // What the channel holds; what lies at `far` or beyond is the sky, in the channel's unit. UsageError: the length
    // of the ray needs the focal length, and it is unknown. `windows` are those of the picture, and must stay.
    DepthReader(const Windows &windows, DepthMeaning meaning, double far, const Camera &camera);

    // Of the i-th pixel of the data window. What is no depth stays none (see sanitize.h).
    float planar(float value, std::size_t i) const;

private:
    const Windows &windows_;
    DepthMeaning meaning_;
    double far_, focal_px_;
    Imath::V2d principal_point_;
};

} // namespace sparselens
