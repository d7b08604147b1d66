// Gathers a picture from packed samples (deep/packed_rows.h) in bands of rows. For each band, the samples that can
// reach it are unpacked, prepared, gathered and dropped. The picture equals, bit for bit, the picture gathered from all
// samples at once.
#pragma once

#include "../deep/packed_rows.h"
#include "gather_picture.h"

namespace sparselens {

// The height of bands. A band is as high as fits into `memory` (bytes) with its samples and the data prepared from
// them. Unless `low`, it is at least as high as its margins (RowReach), even over budget, so that preparation costs at
// most about twice as much as for all rows at once.
struct BandLimits {
    double memory;
    bool low = false;
};

// Like gather_picture() for the LDI of all rows, with the method lens and without a holdout. Bands have whole rows of
// tiles. If a look bends the plane of focus or magnifies the picture, all rows are gathered at once.
Image gather_rows(const PackedRows &rows, const ThinLens &lens, const Imath::Box2i &gathered,
                  const Imath::Box2i &written, const PictureOptions &options, const BandLimits &limits,
                  Progress &progress);

// How many rows away samples influence a row of the picture, and other samples influence these.
struct RowReach {
    int seen = 0;     // samples, facets and fillers this far away reach a pixel
    int prepared = 0; // samples this far from those influence their colours
};
// `across`: pixels, across and down, that become one of the picture.
RowReach reach_of(const PackedRows &rows, const ThinLens &lens, const LensLooks &looks, int across = 1);

} // namespace sparselens
