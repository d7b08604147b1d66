// Combines a gathered picture and two independent renders through the same lens into a picture that is nearer to the
// truth than either. The gathered picture has no noise and is wrong in a few places; the rays are right on average but
// noisy. Candidates made of both are blended in as far as the other render confirms them (cross_validation.h).
//
// The candidates, in this order: those of other programs or other views (given), regressions of the rays on the
// gathered picture in windows of several sizes, the rays themselves, and means over pixels that look
// similar in the current picture.
#pragma once

#include "base/grid.h"
#include "base/progress.h"
#include "finish/tuning.h"
#include "finish/window_means.h"

#include <vector>

namespace sparselens {

// The channels of one layer that are finished together: R, G and B, or a single one. All values are finite; all planes
// have the pixels of `grid`.
struct LayerToFinish {
    ArrayGrid grid;
    Colours gathered;
    Halves rays;
    RayCounts samples = {};
    std::vector<Halves> given = {}; // for each render: its denoised version, or the same picture twice
    std::vector<bool> nothing =
        {};               // pixels without light and coverage in all pictures, which stay so; or empty
    Halves averaged = {}; // the rays with those of frames around (frames_around.h), for candidates; or empty
};

struct FinishedLayer {
    Colours picture;
    Halves of_one; // the pictures of each render, tested by the other: they show the error of the picture
    Values kept;   // 1: only the gathered picture counts, 0: only the rays
};

FinishedLayer finish_layer(const LayerToFinish &layer, Progress &progress);

// Regression of noisy rays on a picture without noise, the guide: in a soft window around each pixel, the straight line
// of the guide that fits the rays best. The guide shows where edges are, the rays show how bright it is. Pixels are
// weighted by the tone curve, so that lamps do not dominate. Where the guide hardly varies, the slope is drawn towards
// that of the whole picture: close to 1 where the guide is right, to 0 where it shows something else. The prediction is
// linear in the rays.
//
// Lines are fitted for cells (window_means.h) and interpolated.

// The weight of each pixel of a guide: 1 / (1 + brightness)^2, exposed.
Values tone_weights(const Colours &guide, float exposure = 1);

class Regression {
public:
    // `guide` is one channel, `weights` belong to its layer; both must outlive the regression.
    Regression(std::span<const float> guide, std::span<const float> weights, const ArrayGrid &grid,
               const FinishTuning::Window &window);

    // The prediction for each pixel; `rays` are the same channel.
    Values of(std::span<const float> rays) const;

private:
    std::span<const float> guide_, weights_;
    Cells cells_;
    int radius_;                      // cells
    Values weight_, mean_, variance_; // of each window: its weight, and the guide's mean and variance
    float square_ = 0;                // of the guide, the weighted mean over the picture
};

// Means of rays over similar pixels nearby (non-local means: A. Buades, B. Coll, J. Morel, 2005). The guide decides
// which pixels are similar, so the means are linear in the rays. They follow edges of any form that the guide shows.

// The means for both renders. `guide` and the renders have the same channels.
Halves means_of_similar(const Halves &rays, const Colours &guide, const ArrayGrid &grid, float exposure = 1);

} // namespace sparselens
