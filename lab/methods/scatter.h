// Scatter, the conceptual algorithm: each sample is spread over its PSF with the exact kernel. Each destination pixel
// keeps a list of the fragments that fall into it, sorts it by depth and blends it by the rule of splats.h, with any
// number of layers. It is slow and obvious, and serves as the reference of the selective gather.
#pragma once

#include "base/image.h"
#include "base/progress.h"
#include "deep/ldi.h"
#include "lens/thin_lens.h"

namespace sparselens {

struct ScatterOptions {
    std::size_t fragments = std::size_t(1)
                            << 24; // held in memory at a time, about; the picture is worked on in parts
};

// Like selective_gather().
Image scatter(const Ldi &ldi, const ThinLens &lens, const ScatterOptions &options, Progress &progress);

} // namespace sparselens
