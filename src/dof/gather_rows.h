// The picture of samples that are held packed (deep/packed_rows.h), gathered in bands of rows: those that can reach a band
// are unpacked, prepared, gathered from and dropped. The picture is the same, bit by bit, as that of all samples at once.
#pragma once

#include "../deep/packed_rows.h"
#include "gather_picture.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace sparselens {

// What decides how high bands are: as high as fits into `memory` (bytes), counting the samples and what a band is gathered from.
// Unless `low`, a band is at least as tall as its margins (RowReach), even over budget; preparation then costs at most
// about twice that of all rows at once.
struct BandLimits {
    double memory;
    bool low = false;
};

// As gather_picture() for the LDI of all rows, by the method lens and without a holdout. Bands have whole rows of tiles. Where a look
// bends the plane of focus or magnifies the picture, all rows are gathered at once.
Image gather_rows(const PackedRows &rows, const ThinLens &lens, const Imath::Box2i &gathered,
                  const Imath::Box2i &written, const PictureOptions &options, const BandLimits &limits,
                  Progress &progress);

// How far, in rows, what the lens makes of a row depends on other rows, and its samples on those of others.
struct RowReach {
    int seen = 0;     // from where samples, and what is taken to lie between and behind them, reach a pixel
    int prepared = 0; // from where those get their colours
};
// `across`: pixels, across and down, that become one of the picture.
RowReach reach_of(const PackedRows &rows, const ThinLens &lens, const LensLooks &looks, int across = 1);

} // namespace sparselens
