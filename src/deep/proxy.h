// LDIs of other sizes: a small one for quick previews, a large one from it, and one with padding around it.
#pragma once

#include "../lens/lens_looks.h"
#include "../lens/thin_lens.h"
#include "ldi.h"

#include <span>

namespace sparselens {

// The purpose of a small LDI.
struct ProxyFor {
    // For a lens: samples are one surface if their disparities, scale / z in pixels of the large LDI, differ by
    // at most `tolerance` pixels. With scale 0, they are one surface if their depths differ by at most a hundredth.
    double scale = 0, tolerance = 0;
    std::span<const float> left = {}; // [sample]: factor on its light; empty: 1
    // [sample]: the first sample of its small pixel on the same surface, whatever their depths; the surface gets their
    // mean depth. Empty: the tolerance alone decides.
    std::span<const std::uint32_t> joined = {};
};

// The LDI at 1 / factor of its size, factor >= 1. A surface gets the harmonic mean of its samples' depths and the mean
// of their positions. Its coverage and colours are its share of the mean of the flattened pixels, so that the flattened
// small LDI is the mean (box filter) of the flattened large one. Samples that the surface hides completely are kept
// behind it. Ids come from its first sample. Ldi::solid is the smallest of its samples, for a lens the largest. Data
// windows whose size is not a multiple of `factor` are padded with empty pixels. The result has a channel A even if
// `ldi` does not.
Ldi proxy(const Ldi &ldi, int factor, const ProxyFor &by = {});

// The LDI at `factor` times its size: each pixel is repeated across and down. Samples lose their positions in the
// pixel.
Ldi enlarged(const Ldi &ldi, int factor);

// The LDI with its data window grown to contain `data`; the new pixels are empty.
Ldi padded(Ldi ldi, const Imath::Box2i &data);

// The pixels of the display window over which a lens of these looks spreads samples, each as far as its own light
// reaches (lens/psf.h); a reach of less than half a pixel does not count. Empty if there are no such pixels.
Imath::Box2i reached_display(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks = {});

} // namespace sparselens
