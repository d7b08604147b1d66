// Thresholds of the warp, with units. Where a measurement exists, the comment quotes it. lab/sweep NAME measures what
// other values cost. Values that a user chooses are options with defaults (warp.h); rules that a device shares are in
// src/kernels.
#pragma once

#include <cstddef>

namespace sparselens {

struct WarpTuning {
    // Largest number of pixels that an LDI grows beyond the centre view on a side.
    static constexpr int most_overscan = 1024;

    // Pixels around the pixel of a view that must not show anything farther either (extend_surfaces.h).
    static constexpr int sight_margin = 1;

    // Solids (extend_surfaces.h). Pixels of disparity: thickness of a surface that no view sees through. With 2,
    // pinecone and macro have .7 and .1 dB less inside their masks.
    static constexpr double solid_px = 4;
    // Pixels of disparity: a view counts as seeing something nearer if it is nearer by at least this.
    static constexpr double solid_nearer_px = 0.5;
    // Pixels of disparity: if depths around differ by less, no gap shows the background, and nothing is solid.
    static constexpr double solid_relief_px = 1;

    // Silhouettes (silhouettes.h). Radius of the pixels that tell the colour of a surface.
    static constexpr int silhouette_radius = 2;
    // Weight of a pixel that may be mixed itself, relative to other pixels.
    static constexpr double silhouette_edge_share = 0.1;
    // Pixels: with less support, the colour of a surface is unknown.
    static constexpr double silhouette_least_support = 0.01;
    // Distance of a mixed colour from the line between the two, as a share of their contrast, ...
    static constexpr double silhouette_residual = 0.2;
    // ... if the surface behind is one pixel, not a mean, ...
    static constexpr double silhouette_residual_of_one = 0.1;
    // ... and a smaller share of either surface may be texture.
    static constexpr double silhouette_least_share_of_one = 0.1;
    // Weight of the background behind a silhouette, relative to samples seen directly: it is estimated from the pixels
    // around.
    static constexpr float estimate_weight = 0.0625f;

    // Strands (matting/thin_structures.h). Radius of the pixels that tell whether one is among strands.
    static constexpr int strand_reach = 2;
    // Jumps in depth among 20 pairs of pixels. Strands that cover half give about 10.
    static constexpr int strand_jumps = 5;
    // Pixels of disparity: distance between strands and the surface behind them.
    static constexpr double strand_apart_px = 2;
    // Pixels: reach of a lamp of a few pixels that strands cross everywhere.
    static constexpr int strand_light_reach = 4;
    // Pixels of disparity: anything less is sky, which has no lamps.
    static constexpr double least_lamp_px = 0.1;
    // Share of the strands around that are dimmer than the colour estimated for them.
    static constexpr double dim_strand = 0.3;
    // Pixels: reach of the strands that tell their colour. With 4, hair before lamps loses 0.2 dB.
    static constexpr int strand_colour_reach = 8;
    // Residual of a colour that two others explain, as a share of it.
    static constexpr double strand_residual = 0.1;

    // Small lamps (lamps/lamp_light.h). Width and height in pixels of the block that tells what surrounds a lamp.
    static constexpr int lamp_block = 16;
    // Least light of a lamp's other pixels, as a share of the brightest one.
    static constexpr float lamp_belongs_to_brightest = 0.02f;
    // Pixels: bright pixels no farther apart than this are one lamp.
    static constexpr int lamp_gap = 3;
    // Largest width or height of a lamp, pixels.
    static constexpr int largest_lamp = 12;

    // Depth of lamps (lamps/lamp_depths.h). Width and height in pixels of a lamp that may lack a pixel of its own.
    static constexpr int small_lamp = 3;
    // Share of the brightest pixel's light: with less, a pixel of a larger lamp is an edge.
    static constexpr double lamp_edge_share = 0.3;
    // Pixels between the positions of one lamp in two views: from the expected one, ...
    static constexpr double lamp_same_place = 0.75;
    // ... and at all.
    static constexpr double lamp_farthest = 64;
    // Lamps of a view: if there are more, none is matched.
    static constexpr std::size_t most_lamps = 1000;
    // Views that must show a lamp at one depth: two may agree by chance.
    static constexpr std::size_t lamp_least_views = 3;

    // Light of lamps (lamps/lamp_light.h). Pixels around a lamp that may hold a part of its light.
    static constexpr int lamp_margin = 2;
    // Share of the light of the lamp and its margin that may come from elsewhere.
    static constexpr double lamp_most_of_surroundings = 0.25;
    // Share of the lamp's light: views that differ by more show different objects, ...
    static constexpr double lamp_most_noise = 0.33;
    // ... and so do those that differ by more than this divided by its pixels.
    static constexpr double lamp_noise_of_pixels = 1;
    // Largest share of the lamp's light that may be changed.
    static constexpr double lamp_largest_change = 0.5;

    // Depth of images in mirrors and glass (images/image_sweep.h). Pixels of disparity: step of the search.
    static constexpr double image_step_px = 0.5;
    // Pixels of disparity: how far behind the camera (below 0) the search goes.
    static constexpr double image_behind_camera_px = 6;
    // Largest number of depths that are tried; for a very near surface the steps become larger.
    static constexpr std::size_t image_most_steps = 320;
    // A block with more depths is searched at half the size first, ...
    static constexpr std::size_t image_many_depths = 64;
    // ... if such blocks are at least this share of all: for fewer, a smaller picture costs more than it saves (0.01 in
    // fence at 1920x1080), ...
    static constexpr double image_many_blocks = 0.02;
    // ... and unless a pixel is already this many pixels of the view wide: in macro, eight would read the views once
    // more for a few blocks.
    static constexpr int image_smallest = 4;
    // Steps that are then tried on either side of a depth that the smaller picture found, ...
    static constexpr std::size_t image_guess_steps = 4;
    // ... at most this many of its pixels away.
    static constexpr int image_guess_reach = 2;
    // Step size of the first pass, in steps: a valley is wider.
    static constexpr std::size_t image_coarse_steps = 2;
    // Pixels of disparity: least distance of an image from the surface that is worth it.
    static constexpr float image_least_px = 0.25f;
    // Share of the views' difference at the surface: a depth that explains them leaves less.
    static constexpr float image_left = 0.5f;
    // Difference at the surface, mean square of R, G and B together: less is invisible.
    static constexpr float image_least_difference = 3e-5f;
    // Factor on the least difference: one and a half steps away the difference must be larger, ...
    static constexpr float image_valley = 1.25f;
    // ... and in any other valley.
    static constexpr float image_rival = 1.4f;
    // Steps on either side that refine a depth, ...
    static constexpr int image_fine_steps = 3;
    // ... and, in disparity, how far apart they are.
    static constexpr double image_fine_px = 0.25;
    // Share of a patch that both views must show to be compared.
    static constexpr float image_least_patch = 0.4f;

    // Images that belong together (images/image_depths.h). Share of a block's pixels that must find a depth before its
    // neighbours are searched.
    static constexpr double image_enough_found = 0.25;
    // Number of the eight blocks beside one that must differ too; at the end of a line only one does.
    static constexpr int image_enough_beside = 2;
    // Radius in pixels of depths that lie on a plane.
    static constexpr int image_plane_reach = 6;
    // Share of the pixels around that must have found a depth, and share of those that must agree (image_one_px).
    static constexpr double image_agreement = 0.4;
    // Pixels of disparity: depths no farther apart than this belong to one image.
    static constexpr float image_one_px = 0.8f;
    // Pixels from which a depth may be continued: Neighbours::reach at most, ...
    static constexpr int image_continued_reach = 8;
    // ... the least number of them, ...
    static constexpr std::size_t image_least_sources = 8;
    // ... the number of repetitions, ...
    static constexpr int image_continuations = 2;
    // ... how far in disparity a surface may lie off the mirror where views cannot be compared, ...
    static constexpr double image_off_mirror_px = 0.25;
    // ... and the difference that views may have there, as a factor on that at the surface, ...
    static constexpr float image_continued_difference = 1.25f;
    // ... or at all, mean square.
    static constexpr float image_continued_least_difference = 1e-5f;

    // Colours of images (images/image_depths.h). Factor on the mean difference of the best views: a view that differs
    // more sees something else, ...
    static constexpr float image_shown_difference = 4;
    // ... unless its difference, mean square, is invisible.
    static constexpr float image_shown_least_difference = 2e-4f;
};

} // namespace sparselens
