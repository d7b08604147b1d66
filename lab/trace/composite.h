// Composites what a ray meets, front to back: surfaces of partial coverage and the slabs between them.
#pragma once

#include "lab/trace/scene.h"

#include <span>

namespace sparselens::lab {

struct Layer {
    double z;           // planar depth; inf: the sky
    Imath::C4f surface; // colour (not premultiplied) and coverage
};

// The premultiplied colour and alpha, seen from z = 0, of layers in order of depth and of slabs that may overlap each
// other and the layers. Where slabs overlap, their densities add up and their colours mix by density, as in
// "Interpreting OpenEXR Deep Pixels" (F. Kainz, 2013).
Imath::C4f composite(std::span<const Layer> layers, std::span<const Slab> slabs);

// The share of light that passes the slabs between two depths.
double transmittance(std::span<const Slab> slabs, double z_from, double z_to);

} // namespace sparselens::lab
