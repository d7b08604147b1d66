// The lens of a photograph whose depth is a disparity, as programs estimate it from one picture: 0 is far, 1 is near,
// and 1 / z is known only up to scale and offset. A lens only compares the 1 / z of a point with that of its focus, so
// the offset does not matter: 1 / z is taken as 1 + disparity, which is nowhere 0. The CoC, R F (1 / focus - 1 / z), is
// then blur (disparity in focus - disparity), with blur = R F, in pixels.
#pragma once

namespace sparselens {

// The blur in pixels, or as a share of the picture's width.
struct PhotographBlur {
    double value = 0.02;
    bool of_width = true;
    double in_pixels(int width) const { return of_width ? value * width : value; }
};

inline double depth_of_disparity(double disparity) { return 1 / (1 + disparity); }
inline double disparity_of_depth(double z) { return 1 / z - 1; }

// The radius of the lens, in the units of depth_of_disparity(), for which R F is `blur`: the radius of the CoC, in
// pixels, at disparity 1 if disparity 0 is in focus.
inline double radius_of_blur(double blur, double focal_px) { return blur / focal_px; }

} // namespace sparselens
