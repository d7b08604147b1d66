// Thresholds of the plan, with units. Where a measurement exists, the comment quotes it.
// lab/sweep NAME measures what other values cost. Values that a user chooses are options with defaults (plan.h).
#pragma once

#include <cstddef>

namespace sparselens {

struct PlanTuning {
    // Mean square, tone-mapped (42 dB): about the error of the layers on scenes without noise. If the noise of a
    // single view is larger, further samples should reduce it.
    static constexpr double noise_that_pays = 6.3e-5;
    // Mean square, tone-mapped. A pixel with more noise is rendered again in every view: it would make the error of the
    // layers on the laboratory's scenes (2e-5, 47 dB) worse by 1.5 dB.
    static constexpr double noise_of_a_pixel_that_pays = 8e-6;
    // Share of all pixels: if fewer are noisy, no view is rendered for them alone.
    static constexpr double few_noisy = 0.01;
    // Share of pixels at edges from which views of twice the size, with a quarter of the samples, are worth the larger
    // files. At 640x360 and 20 rays, grass (.30) gains 2.6 dB and fence (.09) 2.1; mist (.04) loses .6.
    static constexpr double many_edges = 0.05;
    // Scene-linear value: brighter light counts as this bright when the noise of rays is predicted. It is white on any
    // display, and squares of larger values leave too few digits for sums over pictures.
    static constexpr double brightest = 1e4;
    // Least number of candidate views on the rim.
    static constexpr int least_candidates = 8;
    // Pixels of margin around an opening of one pixel. There are many such openings, and a larger margin costs more
    // than it brings (grass: 1.43 full views instead of about one, for 0.02 dB).
    static constexpr int slit_margin = 1;
    // Pixels that a view must uncover: fewer come from rounding positions.
    static constexpr std::size_t least_gain = 8;
    // Factor on the pixels that the even ring uncovers per rendered pixel: views that uncover more replace it, ...
    static constexpr double noticeably_more = 1.1;
    // ... if their total is at least this factor of the ring's.
    static constexpr double about_as_much = 0.95;

    // Blocks on each side of one that tell whether it shows noise, ...
    static constexpr int noise_surroundings = 2;
    // ... and the share of them that must be Gaussian: white noise has four in five, path-traced pictures (64 samples a
    // pixel) half to two thirds, a fine checker in a picture of 160x90 one in seven.
    static constexpr double least_gaussian = 0.4;

    // Pixels to either side along the border of the picture: something as near as the surfaces in them may stand beyond
    // the border and come into view.
    static constexpr int edge_hereabouts = 12;

    // Largest width, in pixels, of the reduced pictures in which motion is found.
    static constexpr int motion_width = 480;
    // The longest motion that is found is the width divided by this.
    static constexpr int motion_reach = 10;
    // Factor between the depths of one surface at two times, or in adjacent pixels.
    static constexpr double depths_of_surface = 1.25;
    // Reduced pixels of a block that its surface must have, and the share of them that the other picture must show.
    static constexpr double least_surface = 16, least_seen_again = 0.5;
    // Variance of the tone-mapped brightness of a block, from which it has texture.
    static constexpr double least_texture = 2e-3;
    // Mean square of the difference, as a factor of a block's variance, up to which the block is found again.
    static constexpr double most_unlike = 0.125;
    // Factor on the least difference, up to which a displacement is as good as the best one.
    static constexpr double equally_good = 1.5;
    // Reduced pixels by which the way back may miss the block that it came from.
    static constexpr double way_back = 1.5;
    // Blocks around one that must have moved alike, ...
    static constexpr int least_alike = 2;
    // ... within so many reduced pixels and this share of the motion.
    static constexpr double alike_pixels = 1, alike_share = 0.2;

    // Pixels: the longest step of what is in focus between two moments of a shutter, ...
    static constexpr double step_in_focus = 2;
    // ... and how much longer it may be for each pixel of the radius of the CoC. fair, whose wheel and ball move by 13
    // pixels at 320x180, has 33.4 dB with 4 moments, 34.7 with 5, 35.3 with 6, 35.5 with 8 and 35.2 with 16; these steps
    // ask for 6. At 640x360 (4: 33.3, 8: 38.0, 16: 38.2) they ask for 10 to 13. grass from a camera that moves in by 0.4
    // (4: 41.3, 6: 42.1, 8: 42.6, 16: 42.1): 8.
    static constexpr double step_of_coc = 0.75;
    // Share of the blocks that may need more moments, because the motion of some blocks is wrong.
    static constexpr double few_blocks = 0.01;

    // Cost of a rectangle besides its pixels, in pixels: two are joined if that wastes less.
    static constexpr double rectangle_overhead = 256;
    // Pixels: more empty columns separate two rectangles of a band of rows, more empty rows separate two bands.
    static constexpr int rectangle_gap = 16;
};

} // namespace sparselens
