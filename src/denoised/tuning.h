// Thresholds of denoised views, with units.
#pragma once

namespace sparselens {

struct DenoisedTuning {
    // Differences are compared as means over squares of side 2 radius + 1: what is smaller than a pixel lies in other pixels of
    // other views. Pixels.
    static constexpr int detail_radius = 1;
    // Radius of the soft window over which details and noise are averaged, pixels. Fence, grass and mirror, 5 rays: a window
    // half as large loses, one twice as large gains .05 to .1 dB, and the worst blocks lose .25.
    static constexpr int window_radius = 2;
    // How many standard errors a single pixel must stand out by to be kept where other views show it too, and where none does.
    static constexpr float standard_errors = 3, standard_errors_alone = 6;
    // The mean of squared differences of Gaussian noise between a view and four others, over their geometric mean: e^-(digamma(2) + ln
    // 2 - ln 4) = 1.31; of the square of one value over its own: 3.56.
    static constexpr float mean_over_geometric = 1.31f, mean_over_geometric_alone = 3.56f;
    // What rounding to half does to a value, relative and squared.
    static constexpr float rounding = 0x1p-20f;
};

} // namespace sparselens
