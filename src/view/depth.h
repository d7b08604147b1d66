// Converts depth, as renderers write it, to planar depth.
#pragma once

#include "../base/image.h"
#include "view.h"

#include <Imath/ImathVec.h>

namespace sparselens {

// The meaning of the numbers of a depth channel: planar z; the length of the ray; 1 / planar z; -z (the z of a camera
// space that looks along its negative axis); a number from 0 to 1 between two planes, linear in z (normalized_depth) or
// in 1 / z, as in depth buffers (hyperbolic_depth); or a disparity (lens/photograph.h).
enum class DepthMeaning { planar, distance, inverse, negative, normalized, hyperbolic, disparity };

// Planes in front of the camera, scene units. Anything at `far` or beyond is sky.
struct DepthRange {
    // One of the two may be infinite. If near is the larger one, normalised depths are white near the camera: 0 at the
    // far plane, and 1 at the near one.
    double near = 0, far = 1e10;
};

// Whether a depth value stands for the sky: `far` and everything beyond (renderers write 1e10, 1e30, infinity or their
// far clip), and 65504, the largest half, to which such values are clamped. For inverse depth: 1 / far and below; for
// normalised and hyperbolic depth: 1 and above.
bool is_sky(DepthMeaning meaning, double value, double far);

// The planar depth of pixel (x, y), EXR coordinates. focal_px (pixels) and the principal point (where the optical axis
// meets the picture, see Camera) are used for ray lengths only. An inverse depth of 0 is infinity. `meaning` is not
// normalized or hyperbolic.
double planar_depth(DepthMeaning meaning, double value, int x, int y, const Windows &windows, double focal_px,
                    const Imath::V2d &principal_point = {0, 0});

// The depth of a value that is 0 at the near plane and 1 at the far one, linear in between. If the far plane is
// infinitely far, as in a depth buffer without a far plane: near / (1 - value).
double normalized_depth(double value, const DepthRange &range);

// The same, but linear in 1 / z: the value is (1 / near - 1 / z) / (1 / near - 1 / far).
double hyperbolic_depth(double value, const DepthRange &range);

class DepthReader {
public:
    // `meaning` says what the channel holds, and `range` is in the unit of its depths. `windows` are the picture's and
    // must outlive the reader. Throws UsageError if ray lengths are to be converted and the focal length is unknown.
    DepthReader(const Windows &windows, DepthMeaning meaning, const DepthRange &range, const Camera &camera);

    // The planar depth of the i-th pixel of the data window. An invalid value stays invalid (see sanitize.h).
    float planar(float value, std::size_t i) const;

private:
    const Windows &windows_;
    DepthMeaning meaning_;
    DepthRange range_;
    bool white_near_; // 1 is near, so values are reversed
    double focal_px_;
    Imath::V2d principal_point_;
};

} // namespace sparselens
