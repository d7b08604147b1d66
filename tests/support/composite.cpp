#include "support/composite.h"

#include <cmath>
#include <set>

namespace sparselens {

namespace {

// Adds a stretch with this optical depth and this light, both spread evenly, behind everything so far: the integral of
// light * exp(-depth * s) for s in [0, 1] is light * (1 - exp(-depth)) / depth.
void add_stretch(Composite &seen, long double &transmittance, long double depth, long double light) {
    seen.colour += transmittance * light * (depth > 0 ? -std::expm1(-depth) / depth : 1);
    transmittance *= std::exp(-depth);
}

long double optical_depth(const TestSample &s) { return -std::log1p(-(long double)s.alpha); }

// The light that a sample emits if none of it is absorbed.
long double light_of(const TestSample &s) {
    return s.alpha > 0 ? s.colour * optical_depth(s) / s.alpha : s.colour;
}

bool is_volume(const TestSample &s) { return s.z_back > s.z; }

} // namespace

Composite composite(const TestPixel &samples) {
    std::set<float> boundaries;
    for (const TestSample &s : samples) boundaries.insert({s.z, s.z_back});
    Composite seen;
    long double transmittance = 1;
    for (auto it = boundaries.begin(); it != boundaries.end(); ++it) {
        long double depth = 0, light = 0;
        for (const TestSample &s : samples)
            if (!is_volume(s) && s.z == *it) {
                depth += optical_depth(s);
                light += light_of(s);
            }
        add_stretch(seen, transmittance, depth, light);
        if (std::next(it) == boundaries.end()) break;
        const float end = *std::next(it);
        depth = light = 0;
        for (const TestSample &s : samples)
            if (is_volume(s) && s.z <= *it && s.z_back >= end) {
                const long double share = ((long double)end - *it) / ((long double)s.z_back - s.z);
                depth += share * optical_depth(s);
                light += share * light_of(s);
            }
        add_stretch(seen, transmittance, depth, light);
    }
    seen.alpha = 1 - transmittance;
    return seen;
}

Composite composite_in_order(const TestPixel &samples) {
    Composite seen;
    for (const TestSample &s : samples) {
        seen.colour += (1 - seen.alpha) * s.colour;
        seen.alpha += (1 - seen.alpha) * s.alpha;
    }
    return seen;
}

} // namespace sparselens
