// The thresholds of the warp, each in its unit, with what was measured of it; of what says nothing, nothing was.
// lab/sweep NAME measures what other values cost. What a user chooses is an option (warp.h), with a default there; rules that a
// device shares are in src/kernels. "Perceptive" is of perceptive depth, in pixels.
#pragma once

#include <cstddef>

namespace sparselens {

struct WarpTuning {
    // Pixels that an LDI grows beyond the centre view on a side, at most.
    static constexpr int most_overscan = 1024;

    // Solids (solids.h). Perceptive: how thick what no view sees through is taken to be.
    static constexpr double solid_px = 4;
    // Pixels of a view around the one that is asked.
    static constexpr int solid_margin = 1;
    // Perceptive: what a view sees nearer, it sees by so much nearer.
    static constexpr double solid_nearer_px = 0.5;
    // Perceptive: of what is no farther than that, no gap shows what lies behind.
    static constexpr double solid_relief_px = 1;

    // Silhouettes (silhouettes.h). Pixels around that tell what a surface shows.
    static constexpr int silhouette_radius = 2;
    // How much a pixel that may be mixed itself tells of its surface, of what others tell.
    static constexpr double silhouette_edge_share = 0.1;
    // Pixels: of a surface that fewer tell of, nothing is known.
    static constexpr double silhouette_least_support = 0.01;
    // Distance of a mixed colour from the line between the two, as a share of their contrast, ...
    static constexpr double silhouette_residual = 0.2;
    // ... where the one behind is one pixel, not a mean, ...
    static constexpr double silhouette_residual_of_one = 0.1;
    // ... and less than this share of either may as well be texture.
    static constexpr double silhouette_least_share_of_one = 0.1;
    // How much what is behind a silhouette counts against what is seen directly: it is taken from the pixels around.
    static constexpr float estimate_weight = 0.0625f;

    // Strands (mixed/wisps.h). Pixels around one that tell whether it is among them.
    static constexpr int strand_reach = 2;
    // Jumps in depth, of 20 pairs of pixels: half of them are expected among strands that cover half.
    static constexpr int strand_jumps = 5;
    // Perceptive: between strands and what is behind them.
    static constexpr double strand_apart_px = 2;
    // Pixels: a lamp of a few pixels, all of them behind strands.
    static constexpr int strand_light_reach = 4;
    // Perceptive: nearer than this is no sky, which has no lamps.
    static constexpr double least_lamp_px = 0.1;
    // Share of the strands around that are dimmer than what they are taken to show.
    static constexpr double dim_strand = 0.3;
    // What two colours leave of a third that they explain, as a share of it.
    static constexpr double strand_residual = 0.1;

    // Small lamps (lamps/compact_lamps.h). Pixels, wide and high, that tell what surrounds a lamp.
    static constexpr int lamp_block = 16;
    // Part of the brightest pixel that others of a lamp have at least.
    static constexpr float lamp_belongs_to_brightest = 0.02f;
    // Pixels: what is bright and lies no farther apart is one lamp.
    static constexpr int lamp_gap = 3;
    // Pixels that one is wide or high, at most.
    static constexpr int largest_lamp = 12;

    // Where lamps stand (lamps/lamp_depths.h). Pixels, wide and high, of a lamp that no pixel need show alone.
    static constexpr int small_lamp = 3;
    // Share of the brightest pixel's light: with less, a pixel of a larger lamp is an edge.
    static constexpr double lamp_edge_share = 0.3;
    // Pixels between where two views show one lamp: from what is expected, ...
    static constexpr double lamp_same_place = 0.75;
    // ... and at all.
    static constexpr double lamp_farthest = 64;
    // Lamps of a view: of more, none is matched.
    static constexpr std::size_t most_lamps = 1000;
    // Views that show a lamp at one depth: two do by chance.
    static constexpr std::size_t lamp_least_views = 3;

    // What light they have (lamps/lamp_light.h). Pixels around a lamp that may hold a part of its light.
    static constexpr int lamp_margin = 2;
    // Share of the light of the lamp and its margin that may come from elsewhere.
    static constexpr double lamp_most_of_surroundings = 0.25;
    // Share of the lamp's light: views that differ by more show different objects, ...
    static constexpr double lamp_most_noise = 0.33;
    // ... and so do those that differ by more than this divided by its pixels.
    static constexpr double lamp_noise_of_pixels = 1;
    // Largest share of the lamp's light that may be changed.
    static constexpr double lamp_largest_change = 0.5;

    // At which depth mirrors and glass show what they show (images/image_sweep.h). Perceptive: between depths that are tried.
    static constexpr double image_step_px = 0.5;
    // Perceptive, below 0: how far behind the camera is searched.
    static constexpr double image_behind_camera_px = 6;
    // Depths that are tried: where the surface is nearer than any that matters, the steps are larger.
    static constexpr std::size_t image_most_steps = 320;
    // A block with more of them is searched at half the size first, ...
    static constexpr std::size_t image_many_depths = 64;
    // ... if they are this share of all blocks: a smaller picture of fewer costs more than it saves. Of fence at 1920x1080 they are 0.01, ...
    static constexpr double image_many_blocks = 0.02;
    // ... and unless a pixel is already so many pixels of the view wide: in macro, eight read the views once more for a few blocks.
    static constexpr int image_smallest = 4;
    // Steps that are tried then on either side of a depth that the smaller picture found, ...
    static constexpr std::size_t image_guess_steps = 4;
    // ... at most so many of its pixels away.
    static constexpr int image_guess_reach = 2;
    // Steps at once, first: a valley is wider.
    static constexpr std::size_t image_coarse_steps = 2;
    // Perceptive, from the surface: less is not worth it.
    static constexpr float image_least_px = 0.25f;
    // Share of the views' difference at the surface: a depth that explains them leaves less.
    static constexpr float image_left = 0.5f;
    // The difference at the surface, mean square, R, G and B together: less is not seen.
    static constexpr float image_least_difference = 3e-5f;
    // Times the least difference: it is more one step and a half away, ...
    static constexpr float image_valley = 1.25f;
    // ... and in any other valley.
    static constexpr float image_rival = 1.4f;
    // Steps on either side by which a depth is refined, ...
    static constexpr int image_fine_steps = 3;
    // ... and perceptive, how far apart they are.
    static constexpr double image_fine_px = 0.25;
    // Share of a patch that both views must show to be compared.
    static constexpr float image_least_patch = 0.4f;

    // Which of them belong together (images/image_depths.h). Of the pixels of a block that found a depth, to search those beside it.
    static constexpr double image_enough_found = 0.25;
    // Number of the eight blocks beside one: more than at the end of a line.
    static constexpr int image_enough_beside = 2;
    // Pixels around, whose depths lie on a plane.
    static constexpr int image_plane_reach = 6;
    // Share of the pixels that found a depth: this many are as near to it as the next constant says.
    static constexpr double image_agreement = 0.4;
    // Perceptive: depths no farther apart are those of one image.
    static constexpr float image_one_px = 0.8f;
    // Pixels from which a depth may be continued: Neighbours::reach at most, ...
    static constexpr int image_continued_reach = 8;
    // ... how many of them there must be, ...
    static constexpr std::size_t image_least_sources = 8;
    // ... how often, ...
    static constexpr int image_continuations = 2;
    // ... and times the difference at the surface that the views may have there, ...
    static constexpr float image_continued_difference = 1.25f;
    // ... or at all, mean square.
    static constexpr float image_continued_least_difference = 1e-5f;

    // What views show there (images/show_images.h). Times the mean of the best views: one that differs more sees something else, ...
    static constexpr float image_shown_difference = 4;
    // ... unless it differs by less than is seen, mean square.
    static constexpr float image_shown_least_difference = 2e-4f;
};

} // namespace sparselens
