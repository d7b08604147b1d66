// LDIs made for a lens from the CoC of their samples, and comparison of pictures of them.
#pragma once

#include "lens/thin_lens.h"
#include "support/ldi_samples.h"

namespace sparselens {

// The depth at which this lens gives CoC c (c < R F / focus; focused on infinity, c < 0).
double depth_of(const ThinLens &lens, double c);

// A picture of many surfaces: 0 to 3 samples per pixel, CoC from -6 to 4 px in four groups, so that layers form, with
// offsets and a few lamps. Channels R, G, B, A (not if opaque), extra.Y.
Ldi random_surfaces(const Windows &windows, const ThinLens &lens, bool opaque, std::uint32_t stream);

double largest_difference(const Image &a, const Image &b);

} // namespace sparselens
