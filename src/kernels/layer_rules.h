// How the splats over a pixel become its colour: depth bins become layers, and layers become the picture
// (dof/selective/blend.h).
#pragma once

#include "kernels/psf_rules.h"

namespace sparselens::kernels {

// A bin with a smaller known sum holds only what rounding left at a disc's edge.
inline constexpr double least_known = 1e-12;

// Bins that follow each other without a gap are one layer.
inline bool joins_layer(int bin, int last_bin) { return bin <= last_bin + 1; }

// The part of a disc around the middle of a pixel that lies in the data window.
inline double window_share(int x_min, int y_min, int x_max, int y_max, double pixel_aspect, int x, int y,
                           double radius) {
    const double left = x + 0.5 - x_min, right = x_max + 0.5 - x, above = y + 0.5 - y_min,
                 below = y_max + 0.5 - y, high = radius * pixel_aspect;
    if (left >= radius && right >= radius && above >= high && below >= high) return 1;
    const double area = area_between(radius, x_min - (x + 0.5), (y_min - (y + 0.5)) / pixel_aspect,
                                     x_max + 1 - (x + 0.5), (y_max + 1 - (y + 0.5)) / pixel_aspect);
    return area / (pi * radius * radius);
}

// The share of light that a layer takes, going from back to front. `known`: what is known of the layer and of what lies
// behind it.
inline double layer_share(double coverage, double known) { return min(1.0, coverage / min(1.0, known)); }
// Composites the light, or the coverage, of a layer over what lies behind it.
inline double over(double share, double light, double behind) { return share * light + (1 - share) * behind; }

} // namespace sparselens::kernels
