// Thresholds of dof-finish, with units. Where a measurement exists, the comment quotes it: dB of fence, grass and mirror (320x180,
// 20 + 20 rays over the lens, views of 20 rays).
#pragma once

#include <array>

namespace sparselens {

struct FinishTuning {
    // Means over squares, three times over.
    struct Window {
        int cell;   // side of the cells for which they are taken, pixels
        int radius; // cells on each side of the middle one
    };
    // The windows of the regressions, the largest first: a later one corrects the earlier ones. More of them change .1 dB at most.
    static constexpr std::array<Window, 3> regression_windows{{{2, 4}, {2, 2}, {1, 1}}};
    // How much a slope is drawn towards that of the whole picture, as a share of the squared mean of the guide.
    static constexpr float regression_prior = 0.1f;

    // The mean over similar pixels: how far away they are looked for, pixels. Of mirror, it gains 1.4 dB.
    static constexpr int similar_reach = 4;
    // How different two pixels may be, tone-mapped and squared, before one counts less for the other.
    static constexpr float similar_noise = 1e-4f;

    // Side of the cells for which trust is worked out, pixels; all that follows is in cells.
    static constexpr int trust_cell = 2;
    // Radius of the window in which the energy of a candidate is compared with its noise.
    static constexpr int energy_radius = 1;
    // The ring in which the other render confirms a candidate: the half sides of its outer and inner square. The inner square is
    // left out, so that the noise of a pixel cannot confirm itself.
    static constexpr int ring_outer = 5, ring_inner = 1;
    // Radius of the window over which trust is smoothed.
    static constexpr int trust_radius = 1;
    // How much more than other errors the noise of a candidate counts, because it sparkles in a sequence. In pulls of fence and
    // mirror (80 rays), 0, 1, 2 and 3 leave 1776, 1180, 827, 606 and 2325, 1624, 1187, 901 pixels that jump by .02, at 44.9,
    // 44.7, 44.6, 44.5 and 48.7, 48.7, 48.5, 48.4 dB.
    static constexpr double noise_costs = 2;
    // Classes of pixels for each of the two measures of trust.
    static constexpr int classes = 12;
    // Side of the blocks whose spread tells how certain the trust in a class is, pixels.
    static constexpr int block_px = 32;

    // Side of the blocks that count by how well a mistake explains them, pixels, and how often it is fitted anew.
    static constexpr int mistake_block_px = 16, mistake_passes = 8;
    // A mistake is named that explains this share of the difference of both renders from the gathered picture, ...
    // Fence, grass, mirror, mist: .01 at most where there is none; .24 by 5 % of exposure, .39 by half a pixel.
    static constexpr double mistake_share = 0.1;
    // ... on which they differ by this share at most, ...
    static constexpr double mistake_disagreement = 0.25;
    // ... and which is at least this large: relative, and pixels.
    static constexpr double mistake_brightness = 0.02, mistake_shift = 0.15;

    // Headers name another lens from this share on, and another rotation of its blades. Below, f-numbers are rounded.
    static constexpr double lens_difference = 0.02, turned_degrees = 2;

    // Radius of the window over which the map of the estimated error is averaged, pixels.
    static constexpr int error_radius = 4;
    // Values below this count as this dark where an error is seen on a display: its tone curve has no slope at 0.
    static constexpr float darkest = 0.003f;
};

} // namespace sparselens
