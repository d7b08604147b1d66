// What a ray gathers front to back: surfaces of partial coverage, and the slabs between them.
#pragma once

#include "lab/trace/scene.h"

#include <span>

namespace sparselens::lab {

struct Layer {
    double z;           // planar depth; inf: the sky
    Imath::C4f surface; // colour (not premultiplied) and coverage
};

// Layers in order of depth, and slabs that may overlap each other and the layers, seen from z = 0: premultiplied
// colour and alpha. Where slabs overlap their densities add up and their colours mix by density, as
// "Interpreting OpenEXR Deep Pixels" (F. Kainz, 2013) has it.
Imath::C4f composite(std::span<const Layer> layers, std::span<const Slab> slabs);

// Share of light that passes the slabs between two depths.
double transmittance(std::span<const Slab> slabs, double z_from, double z_to);

} // namespace sparselens::lab
