// Thresholds of denoised views, with units.
#pragma once

namespace sparselens {

struct DenoisedTuning {
    // Differences are compared as means over squares of side 2 radius + 1, because details smaller than a pixel lie in
    // different pixels of different views. Pixels.
    static constexpr int detail_radius = 1;
    // Radius of the soft window over which details and noise are averaged, pixels. On fence, grass and mirror with 5
    // rays, a window half as large loses, and one twice as large gains .05 to .1 dB but the worst blocks lose .25.
    static constexpr int window_radius = 2;
    // By how many standard errors a single pixel must stand out to be kept, if other views show it too, and if none
    // does.
    static constexpr float standard_errors = 3, standard_errors_alone = 6;
    // For Gaussian noise, the mean of squared differences between a view and four others, over their geometric mean:
    // e^-(digamma(2) + ln 2 - ln 4) = 1.31. For the square of one value, over its own geometric mean: 3.56.
    static constexpr float mean_over_geometric = 1.31f, mean_over_geometric_alone = 3.56f;
    // The effect of rounding to half on a value, relative and squared.
    static constexpr float rounding = 0x1p-20f;
};

} // namespace sparselens
