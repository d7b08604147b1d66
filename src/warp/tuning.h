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
    // Of the brightest pixel's light: with less, a pixel of a larger lamp is an edge.
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
    // Of the light of the lamp and its margin: what is not the lamp's.
    static constexpr double lamp_most_of_surroundings = 0.25;
    // Of the lamp's light: views that differ by more show different things, ...
    static constexpr double lamp_most_noise = 0.33;
    // ... and so do those that differ by more than this divided by its pixels.
    static constexpr double lamp_noise_of_pixels = 1;
    // Of the lamp's light: what is changed of it at most.
    static constexpr double lamp_largest_change = 0.5;
};

} // namespace sparselens
