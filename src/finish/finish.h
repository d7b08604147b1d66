// Combines a gathered picture and two independent renders through the same lens into a picture that is nearer to the
// truth than either. The gathered picture has no noise and is wrong in a few places; the rays are right on average but
// noisy. Candidates made of both are blended in as far as the other render confirms them (trust.h).
//
// The candidates, in this order: those of other programs or other views (given), regressions of the rays on the
// gathered picture in windows of several sizes (regression.h), the rays themselves, and means over pixels that look
// similar in the current picture (similar_pixels.h).
#pragma once

#include "base/grid.h"
#include "base/progress.h"
#include "finish/colours.h"

#include <vector>

namespace sparselens {

// The channels of one layer that are finished together: R, G and B, or a single one. All values are finite; all planes
// have the pixels of `grid`.
struct LayerToFinish {
    Grid grid;
    Colours gathered;
    Halves rays;
    std::array<double, 2> samples{1, 1}; // per pixel, > 0: of each render
    std::vector<Halves> given = {};      // for each render: its denoised version, or the same picture twice
    Halves averaged = {}; // the rays with those of frames around (frames_around.h), for candidates; or empty
};

struct FinishedLayer {
    Colours picture;
    Halves of_one; // the pictures of each render, tested by the other: they show the error of the picture
    Values kept;   // 1: only the gathered picture counts, 0: only the rays
};

FinishedLayer finish_layer(const LayerToFinish &layer, Progress &progress);

} // namespace sparselens
