// The thresholds of the plan, each in its unit, with what was measured of it; of what says nothing, nothing was.
// lab/sweep NAME measures what other values cost. What a user chooses is an option (plan.h), with a default there.
#pragma once

#include <cstddef>

namespace sparselens {

struct PlanTuning {
    // What the layers leave of error on scenes without noise is about this, mean square, tone-mapped (42 dB): where the noise of a
    // single view is more, it is noise that further samples have to fight.
    static constexpr double noise_that_pays = 6.3e-5;
    // Mean square, tone-mapped. Where a pixel's noise is more, it is asked for again from every view: it would make what the
    // layers leave of error on today's scenes (2e-5, 47 dB) worse by a dB and a half.
    static constexpr double noise_of_a_pixel_that_pays = 8e-6;
    // Share of all pixels: where fewer are noisy, no view is rendered for them alone.
    static constexpr double few_noisy = 0.01;
    // Share of pixels at edges from which views of twice the size, with a quarter of the samples, are worth the larger files. At 640x360
    // and 20 rays, grass (.30) wins 2.6 dB by them and fence (.09) 2.1; mist (.04) loses .6.
    static constexpr double many_edges = 0.05;
    // Views on the rim that are candidates at least.
    static constexpr int least_candidates = 8;
    // Pixels around an opening of one pixel: more around so many of them costs more than it brings (grass: 1.43 instead of
    // about one view, for 0.02 dB).
    static constexpr int slit_margin = 1;
    // Pixels that a view uncovers: less is rounding of where surfaces land.
    static constexpr std::size_t least_gain = 8;
    // Times as much as the even ring, for each pixel rendered: others that uncover more take its place, ...
    static constexpr double noticeably_more = 1.1;
    // ... if they uncover so many times as much in all.
    static constexpr double about_as_much = 0.95;

    // Blocks around one, on each side, that tell whether what it shows is noise, ...
    static constexpr int noise_surroundings = 2;
    // ... and the share of them that are Gaussian then: of white noise it is four in five, of path-traced pictures (64 samples a
    // pixel) half to two thirds, of a fine checker in a picture of 160x90 one in seven.
    static constexpr double least_gaussian = 0.4;

    // Pixels from the frame's edge, along it: something as near as what lies there may stand beyond it and come into view.
    static constexpr int edge_hereabouts = 12;

    // The cost of a rectangle besides its pixels, in pixels: two are joined where that wastes less.
    static constexpr double rectangle_overhead = 256;
    // Pixels: more of empty columns part two rectangles of a band of rows, more of empty rows those of two bands.
    static constexpr int rectangle_gap = 16;
};

} // namespace sparselens
