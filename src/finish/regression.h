// Regression of noisy rays on a picture without noise: in a soft window around each pixel, the straight line of the guide that
// fits the rays best. The guide says where edges are, the rays say how bright it is. Pixels count by the tone curve, so that
// lamps do not decide for all. Where the guide hardly varies, the slope is drawn towards that of
// the whole picture: close to 1 where the guide is right, to 0 where it shows something else. The prediction is linear in the rays.
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
    // `guide` is one channel, `weights` those of its layer; both must outlive it.
    Regression(std::span<const float> guide, std::span<const float> weights, const Grid &grid,
               const FinishTuning::Window &window);

    // What the window says of each pixel; `rays` are the same channel.
    Values of(std::span<const float> rays) const;

private:
    std::span<const float> guide_, weights_;
    Cells cells_;
    int radius_;                      // cells
    Values weight_, mean_, variance_; // of the windows: of the guide
};

} // namespace sparselens
