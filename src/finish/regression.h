// Regression of noisy rays on a picture without noise: in a soft window around each pixel, the straight line of the guide that
// fits the rays best. The guide says where edges are, the rays say how bright it is. Pixels count by the tone curve, so that
// lamps do not decide for all. Where the guide hardly varies, the slope is drawn towards that of
// the whole picture: close to 1 where the guide is right, to 0 where it shows something else. The prediction is linear in the rays.
#pragma once

#include "base/grid.h"
#include "finish/colours.h"

#include <span>

namespace sparselens {

// The weight of each pixel of a guide: 1 / (1 + brightness)^2.
Values tone_weights(const Colours &guide);

class Regression {
public:
    // `guide` is one channel, `weights` those of its layer; both must outlive it. `radius` is that of soft_mean(), pixels.
    Regression(std::span<const float> guide, std::span<const float> weights, const Grid &grid, int radius);

    // What the window says of each pixel; `rays` are the same channel.
    Values of(std::span<const float> rays) const;

private:
    std::span<const float> guide_, weights_;
    Grid grid_;
    int radius_;
    Values weight_, mean_, variance_; // of the windows: of the guide
};

} // namespace sparselens
