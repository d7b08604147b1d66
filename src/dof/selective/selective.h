// Selective gather: each destination pixel gathers the samples whose PSF covers it, clusters them into a few
// layers by perceptive depth and blends those front to back (blend.h states the rule). Tiles make it fast: a
// tile looks only at the blocks of samples that can reach it (splat_blocks.h). scatter.h is its slow reference.
#pragma once

#include "base/image.h"
#include "base/progress.h"
#include "deep/ldi.h"
#include "lens/thin_lens.h"

namespace sparselens {

struct SelectiveOptions {
    int layers = 8; // most a destination pixel keeps apart, >= 1
};

// Windows and channels are the LDI's; where nothing is known the picture is transparent. Ids are the front
// samples'. The LDI is tidy; the lens may have any radius > 0.
Image selective_gather(const Ldi &ldi, const ThinLens &lens, const SelectiveOptions &options,
                       Progress &progress);

} // namespace sparselens
