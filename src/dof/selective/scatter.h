// Scatter: the conceptual algorithm. Each sample is spread into its PSF with the exact kernel, each
// destination pixel keeps the list of what fell into it, sorts it by depth and blends it by the rule of
// blend.h, with as many layers as there are. Slow and obvious: it is what the selective gather is checked
// against.
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

// As selective_gather.
Image scatter(const Ldi &ldi, const ThinLens &lens, const ScatterOptions &options, Progress &progress);

} // namespace sparselens
