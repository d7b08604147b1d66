// Thresholds of dof-finish, with units. Where a measurement exists, the comment quotes it: dB for fence, grass and
// mirror (320x180, 20 + 20 rays over the lens, views of 20 rays).
#pragma once

#include <array>

namespace sparselens {

struct FinishTuning {
    // Means over squares, applied three times.
    struct Window {
        int cell;   // side of the cells for which they are computed, pixels
        int radius; // cells on each side of the middle one
    };
    // The windows of the regressions, the largest first: later ones correct earlier ones. More windows change .1 dB at
    // most.
    static constexpr std::array<Window, 3> regression_windows{{{2, 4}, {2, 2}, {1, 1}}};
    // How strongly a slope is drawn towards that of the whole picture, as a share of the squared mean of the guide.
    static constexpr float regression_prior = 0.1f;
    // The prior's part where the guide is black, as a share of the guide's mean square in the whole picture.
    static constexpr float regression_floor = 1e-3f;
    // When a picture is exposed for the tone curve, a pixel counts for at most this many times the mean of lit pixels.
    static constexpr double most_over_mean = 16;

    // The mean over similar pixels: the search distance, pixels. On mirror it gains 1.4 dB.
    static constexpr int similar_reach = 4;
    // How different two pixels may be, tone-mapped and squared, before they count less for each other.
    static constexpr float similar_noise = 1e-4f;

    // Side of the cells for which trust is computed, pixels. The values below are in cells.
    static constexpr int trust_cell = 2;
    // The squares that test a candidate: cells on each side of the middle one. A smaller square changes the share of a
    // larger one by what exceeds this many standard deviations.
    static constexpr std::array<int, 4> square_radii{31, 15, 7, 3};
    static constexpr double square_deviations = 1.5;
    // Radius of the window over which trust is smoothed.
    static constexpr int trust_radius = 1;
    // How much more noise of the changed picture counts than other errors, because noise sparkles in a sequence. With 80
    // rays of two seeds at 160x90, the values .5, .75, 1 and 2 leave 181, 157, 146 and 109 pixels of fence, and 105, 68, 45
    // and 14 of mirror, that jump by .02, at 39.3, 39.2, 39.0 and 38.6 dB, and 44.1, 43.8, 43.6 and 42.8 dB.
    static constexpr double noise_costs = 0.75;
    // Radius of the window in which pixels must agree to stay as gathered, pixels.
    static constexpr int agreed_radius = 2;
    // Classes of pixels by how much the gathered picture has moved (frames_around.h).
    static constexpr int classes = 12;
    // A candidate is not believed if it gains less over the whole picture than this many standard deviations of the
    // gain. With 80 rays, 0, 1 and 2 lose .19, .13, .01 dB of the gathered picture on lamps, and .20, .17, .10 dB on
    // reliefs before lamps; fence has 46.9, 46.9, 46.8 and grass 45.0 dB.
    static constexpr double proof_deviations = 2;
    // Side of the blocks whose spread shows how certain a mean is, pixels.
    static constexpr int block_px = 32;

    // Two renders have the same noise if they are equal in this share of the pixels in which light varies (same_noise),
    // or of the peaks (same_excess). A peak's second difference along its row is more than `rough` of its value and
    // twice that of the gathered picture. Peaks must be this share of all pixels (least_excess). Equal peaks of good
    // renders: .05 at most; with half of another render: .22 to .5.
    static constexpr float rough = 1.0f / 64;
    static constexpr double same_noise = 0.9, same_excess = 0.2, least_excess = 0.02;
    // Noise is alike if, beyond chance, this share of pairs of pixels are brighter in the same render. The pixels of a
    // pair are this far apart, farther than filters of pixels reach. Good renders: .005 at most; medians of 5 x 5
    // pixels: .02 to .1; denoised renders: .01 to .2, but for 140 rays, which a denoiser leaves as they are.
    static constexpr int noise_apart = 3;
    static constexpr double noise_alike = 0.01;
    // The noise is also the same if so much of it is a multiple of the other (NoiseOfTwo::multiple).
    static constexpr double same_multiple = 0.6;
    // A render has too little noise if the median of blocks of this side finds less than this part of what its samples
    // tell.
    static constexpr double little_noise = 0.4;
    static constexpr int noise_block_px = 16;

    // A firefly (fireflies.h) is this many times as bright as the pixel of this rank, counted from the brightest one,
    // among those within this radius. Few rays hit the hidden lamps of macro: it loses .03 dB by this, .5 dB with rank 6,
    // and 7 dB with rank 2 within radius 2.
    static constexpr float firefly_times = 4;
    static constexpr int firefly_radius = 8;
    static constexpr std::size_t firefly_rank = 4;

    // Side, in pixels, of the blocks that count by how well a mistake explains them; and the number of fits.
    static constexpr int mistake_block_px = 16, mistake_passes = 8;
    // A mistake is reported if it explains this share of the difference of both renders from the gathered picture, ...
    // Fence, grass, mirror, mist: .01 at most without a mistake; .24 with 5 % of exposure, .39 with half a pixel.
    static constexpr double mistake_share = 0.1;
    // ... the renders' fits differ by at most this share, ...
    static constexpr double mistake_disagreement = 0.25;
    // ... and it is at least this large: relative, and in pixels.
    static constexpr double mistake_brightness = 0.02, mistake_shift = 0.15;

    // Smallest relative difference, and smallest rotation of blades, that make another lens. Smaller ones come from
    // rounded f-numbers.
    static constexpr double lens_difference = 0.02, turned_degrees = 2;
    // The same for the optical axis, widths of the picture: a pixel of 1000.
    static constexpr double axis_difference = 0.001;

    // Rays of each view beyond which rays through the lens are worth more (plan/plan.h). Five views, 320 rays in all;
    // 4, 8, 16, 32: fence 47.9, 48.7, 48.9, 48.7 dB; grass 48.4, 48.6, 48.4, 48.1; mirror 50.7, 51.6, 51.5, 51.2.
    static constexpr int rays_per_view = 8;

    // Mean square, tone-mapped (49 dB): if less noise is predicted for all rays through the lens, one render of them is
    // better than a finished picture. Without a denoiser (lab/results/rivals.md), 320 rays on fence, grass, mirror and
    // mist (predicted: 45.3, 47.7, 47.9, 61.7 dB): 45.6, 49.5, 51.4, 73.2 dB in one render, finished 48.7, 48.6, 51.6,
    // 71.5; 1280 rays (predicted: 51.3, 53.7, 53.9, 67.7) have 52.8, 56.3, 58.4, 79.7, finished 51.5, 55.2, 57.4, 78.3.
    static constexpr double noise_that_views_do_not_reach = 1.25e-5;

    // Radii of the soft windows in which residuals of two frames, and their gathered pictures, are compared, pixels.
    static constexpr int residual_radius = 4, moved_radius = 1;
    // How much a change of residuals in a window must exceed what noise may show there, as a share of the noise: three
    // standard deviations of a mean of 250 pixels, as many as a soft window of radius 4 has.
    static constexpr float residual_deviations = 0.19f;
    // Pixels are told apart by how much their gathered pictures have changed, relative to the noise, up to e to this
    // power and its inverse.
    static constexpr float log_of_movement = 14;

    // Layers add up to the beauty if they differ from it by this share of its light, which half floats round by 2.5e-4.
    static constexpr double groups_apart = 2e-3;

    // Radius of the window over which the map of the estimated error is averaged, pixels.
    static constexpr int error_radius = 4;
    // Side of the blocks that ask for rays, pixels; into how many rectangles a picture is cut at most; and the share of
    // its cost that a cut must save.
    static constexpr int ask_block_px = 8;
    static constexpr std::size_t most_pieces = 16;
    static constexpr double least_saving = 1e-3;
    // More rays are asked for nowhere.
    static constexpr double most_rays = 1e6;
    // Darker values count as this dark when an error is judged on a display, because its tone curve has no slope at 0.
    static constexpr float darkest = 0.003f;
};

} // namespace sparselens
