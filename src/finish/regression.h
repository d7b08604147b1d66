// Regression of noisy rays on a picture without noise, the guide: in a soft window around each pixel, the straight line
// of the guide that fits the rays best. The guide shows where edges are, the rays show how bright it is. Pixels are
// weighted by the tone curve, so that lamps do not dominate. Where the guide hardly varies, the slope is drawn towards
// that of the whole picture: close to 1 where the guide is right, to 0 where it shows something else. The prediction is
// linear in the rays.
//
// Lines are fitted for cells (cells.h) and interpolated.
#pragma once

#include "finish/cells.h"
#include "finish/tuning.h"

namespace sparselens {

// The weight of each pixel of a guide: 1 / (1 + brightness)^2.
Values tone_weights(const Colours &guide);

class Regression {
public:
    // `guide` is one channel, `weights` belong to its layer; both must outlive the regression.
    Regression(std::span<const float> guide, std::span<const float> weights, const Grid &grid,
               const FinishTuning::Window &window);

    // The prediction for each pixel; `rays` are the same channel.
    Values of(std::span<const float> rays) const;

private:
    std::span<const float> guide_, weights_;
    Cells cells_;
    int radius_;                      // cells
    Values weight_, mean_, variance_; // of each window: its weight, and the guide's mean and variance
};

} // namespace sparselens
