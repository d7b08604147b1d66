// The selective gather: each destination pixel gathers the samples whose PSF covers it, clusters them into a few layers
// by disparity and blends these front to back (splats.h states the rule). Tiles make it fast: a tile visits only
// the blocks of samples that can reach it. lab/methods/scatter.h is its slow reference.
#pragma once

#include "base/image.h"
#include "base/progress.h"
#include "deep/ldi.h"
#include "lens/thin_lens.h"

namespace sparselens {

class TileDevice; // dof/device/tile_device.h

struct SelectiveOptions {
    int layers = 8;               // the largest number of layers kept apart in a pixel, >= 1
    TileDevice *device = nullptr; // if given, gathers the tiles that it can
};

// The windows and channels are those of the LDI; where nothing is known the picture is transparent. Ids are those of
// the front samples. The LDI must be tidy; the lens may have any radius > 0.
Image selective_gather(const Ldi &ldi, const ThinLens &lens, const SelectiveOptions &options,
                       Progress &progress);

} // namespace sparselens
