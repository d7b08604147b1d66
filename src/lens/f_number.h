// The f-number: the focal length over the diameter of the aperture.
#pragma once

namespace sparselens {

// Radius of the aperture in scene units, [0, inf); 0 for an f-number of infinity. fstop in (0, inf], focal_mm and
// metres_per_unit (the length of a scene unit) in (0, inf).
double radius_of(double fstop, double focal_mm, double metres_per_unit = 1);

// The inverse: the f-number, infinity for a radius of 0.
double fstop_of(double radius, double focal_mm, double metres_per_unit = 1);

} // namespace sparselens
