// Converts the depth channel of a picture to planar depth.
#pragma once

#include "base/image.h"
#include "view/camera.h"
#include "view/depth.h"

namespace sparselens {

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
