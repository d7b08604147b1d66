#include "lab/trace/composite.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens::lab {

namespace {

struct Gathered {
    Imath::V3d colour{0, 0, 0}; // double: weights multiply over many layers
    double passes = 1;          // share of light that the next layers still contribute
};

Imath::V3d as_vector(const Imath::C3f &c) { return {c.x, c.y, c.z}; }

// Crosses the slabs from z to z_to, piece by piece between the planes where one begins or ends.
void cross_slabs(std::span<const Slab> slabs, double z, double z_to, Gathered &g) {
    while (z < z_to) {
        double next = z_to, density = 0;
        Imath::V3d emission(0, 0, 0);
        for (const Slab &slab : slabs) {
            if (slab.z_front > z) next = std::min(next, slab.z_front);
            if (slab.z_front > z || slab.z_back <= z) continue;
            next = std::min(next, slab.z_back);
            density += slab.density;
            emission += slab.density * as_vector(slab.colour);
        }
        if (density > 0) {
            const double stopped = -std::expm1(-density * (next - z));
            g.colour += g.passes * stopped / density * emission;
            g.passes *= 1 - stopped;
        }
        z = next;
    }
}

} // namespace

Imath::C4f composite(std::span<const Layer> layers, std::span<const Slab> slabs) {
    Gathered g;
    double z = 0;
    for (const Layer &layer : layers) {
        if (!slabs.empty()) cross_slabs(slabs, z, layer.z, g);
        z = layer.z;
        const double kept = g.passes * double(layer.surface.a);
        g.colour += kept * Imath::V3d(layer.surface.r, layer.surface.g, layer.surface.b);
        g.passes -= kept;
    }
    if (!slabs.empty()) cross_slabs(slabs, z, std::numeric_limits<double>::infinity(), g);
    return {float(g.colour.x), float(g.colour.y), float(g.colour.z), float(1 - g.passes)};
}

double transmittance(std::span<const Slab> slabs, double z_from, double z_to) {
    double depth = 0;
    for (const Slab &slab : slabs)
        depth += slab.density * std::max(0.0, std::min(slab.z_back, z_to) - std::max(slab.z_front, z_from));
    return std::exp(-depth);
}

} // namespace sparselens::lab
