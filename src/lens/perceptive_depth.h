// Perceptive depth R F / z, in pixels, from the lens's scale R F (pixels times scene units) alone, for code that
// compares depths and needs no focus. See perceptive_depth(lens, z) in thin_lens.h.
#pragma once

namespace sparselens {

inline double perceptive_scale(double radius, double focal_px) { return radius * focal_px; }

inline double perceptive_depth(double scale, double z) { return scale / z; }

// The inverse: the depth that has this perceptive depth.
inline double depth_of_perceptive(double scale, double perceptive) { return scale / perceptive; }

// The difference in 1 / z of two depths whose perceptive depths differ by `perceptive`.
inline double inverse_depth_step(double scale, double perceptive) { return perceptive / scale; }

} // namespace sparselens
