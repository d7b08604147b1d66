// A gathered picture and two independent renders through the same lens, made into a picture that is nearer to the truth than
// either. The gathered picture has no noise and is wrong in a few places; the rays are right in the mean and noisy. Candidates
// made of both are blended in as far as the other render confirms them (trust.h).
//
// The candidates, in this order: what other programs or other views made (given), regressions of the rays on the gathered picture
// in windows of several sizes (regression.h), the rays themselves, and means over pixels that look similar in the picture so
// far (similar_pixels.h).
#pragma once

#include "base/grid.h"
#include "base/progress.h"
#include "finish/colours.h"

#include <vector>

namespace sparselens {

// The channels of one layer that are finished together: R, G and B, or one alone. All values are finite; all planes have
// the pixels of `grid`.
struct LayerToFinish {
    Grid grid;
    Colours gathered;
    Halves rays;
    std::array<double, 2> samples{1, 1}; // a pixel, > 0: of each render
    std::vector<Halves> given = {}; // of each render: what a denoiser made of it, or the same picture twice
};

struct FinishedLayer {
    Colours picture;
    Halves of_one; // the same of each render, tested by the other: they show what the picture's error is
    Values kept;   // 1: the gathered picture alone, 0: what rays say
};

FinishedLayer finish_layer(const LayerToFinish &layer, Progress &progress);

} // namespace sparselens
