// Thresholds of dof-match, with units. Where a measurement exists, the comment quotes it.
#pragma once

#include <array>
#include <cstddef>

namespace sparselens {

struct MatchTuning {
    // Side of the blocks in which the plate is compared with a gathered picture, pixels of the compared pictures.
    static constexpr int compared_block_px = 16;
    // The least share of a block's pixels that must be comparable.
    static constexpr double least_share = 0.6;
    // The plate's values are rounded and compressed: a fit is never better than this, rms of tone-mapped values.
    static constexpr double least_error = 0.001;
    // Pixels of about one value make a point of the tone curve: values in [0, 1) are divided into so many.
    static constexpr int curve_points = 128;
    // A block counts for the tone curve if its error is at most so many times that of most blocks.
    static constexpr double alike = 2;
    // The errors of a fit have the tails of Student's t distribution with so many degrees of freedom; the number of
    // passes of the fit.
    static constexpr double tails = 4;
    static constexpr int robust_fits = 4;

    // A plate clips its highlights if most of its bright pixels, relative to the largest value, are among the brightest.
    // Clipped lamps with grain of 0.03 have 66 % there, other pictures 10 to 20 %.
    static constexpr double bright = 0.95, brightest = 0.99, clipped_share = 0.4;
    // How many times brighter than white clipped highlights count. With 1, three plates of scales and macro had a radius
    // that was 2 to 10 % too small, with 4 and 64 at most 2 %; with 16, a plate of white squares was off by 0.1 stops.
    static constexpr float clipped_factor = 4;

    // A block shows something if a fit, in some place, explains this share of its variance.
    static constexpr double explained = 0.3;
    // How far the plate is moved to compare blocks with other places, pixels.
    static constexpr std::array<std::array<int, 2>, 8> other_places{
        {{23, 5}, {-23, -7}, {7, 22}, {-5, -23}, {37, -31}, {-35, 33}, {51, 45}, {-53, -43}}};

    // The ridge that draws the factors of colours (f and g in blocks.h) to 0, in variances that the other terms leave.
    static constexpr double tint_ridge = 10;
    // The least number of blocks that show something, and the least share of them that match. Plates of other shots
    // match in 7 to 17 %, plates of the shot with an actor over a third of them in 26 % and more.
    static constexpr int least_textured = 6;
    static constexpr double least_matched = 0.22;
    // The least variance of blur by motion, square pixels of the compared pictures. Plates that stand still have up to
    // 0.2, plates that move by 7 to 11 pixels 0.6 to 2.9.
    static constexpr double motion_variance = 0.6;
    // A picture whose circles of confusion are all smaller is in focus, pixels of the plate.
    static constexpr double all_in_focus_px = 0.75;
    // The widest interval, to each side, that is a result: pixels of CoC and stops.
    static constexpr double widest_coc_px = 1.5, widest_stops = 0.6;
    // Two guesses that are this far apart, pixels of CoC, must differ in likelihood by as many standard deviations.
    static constexpr double apart_px = 1.5, least_lead = 1.5;
    // A guess of the search that is worse by so many deviations is wrong.
    static constexpr double certain_lead = 5;
    // The error of gathered pictures, besides the spread of the blocks: in compared pixels of CoC and as a share of the
    // radius. On 200 plates, 92 % of the intervals contain the true value; 90 % should. Pictures of next frames have more
    // noise, and the radius of a rack's frames is up to 6 % too small.
    struct GatherError {
        double coc_px, share;
    };
    // The variance of the blur of a CoC c is wrong by this, square pixels, divided by 1 + c^2. In regions with CoCs of at
    // most 1.3 to 1.7 pixels, radii were 24 to 60 % too large; their stated deviation is 15 to 25 % with this.
    static constexpr double small_blur_error = 0.3;
    static constexpr GatherError first_frame_error{0.03, 0.015}, next_frame_error{0.1, 0.03};

    // The shape of the lens (shape_search.h): the squeezes of anamorphic lenses; blades; how many rotations of each
    // number of blades, and the finest turn, degrees; how many lenses a refinement compares; by how many deviations a
    // shape must fit better than a simpler one; the least CoC of the plate that shows a shape, and the CoC to which it
    // is reduced, pixels.
    static constexpr std::array<double, 6> squeezes{1.25, 1.33, 1.5, 1.65, 1.8, 2};
    static constexpr int fewest_blades = 4, most_blades = 9, rotations = 4, shape_lenses = 20;
    static constexpr double finest_turn = 1.5, shape_lead = 3, least_shape_px = 6, shape_px = 8;

    // Smoothing over frames (smooth_keys.h): the stiffest and the softest curve, relative to the largest weight of a
    // value; how many values the given deviations count for; the passes that find values which are far off.
    static constexpr double stiffest = 1e6, least_stiff = 1e-4, given_deviations = 4;
    static constexpr int robust_passes = 4;

    // Widths to which pictures are reduced for the search and for the final fit, pixels.
    static constexpr int search_width = 140, final_width = 360;
    // Distance of neighbouring guesses of the search, pixels of CoC at the reduced size, or as a share of the range of
    // the CoC if that is more.
    static constexpr double search_step = 1.25, search_share = 0.1;
    // Guesses of the search that are this many steps apart may lead to different maxima of the likelihood.
    static constexpr double steps_apart = 1.5;
    // The widest lens of the search, relative to the LDI's; the narrowest blurs by this many reduced pixels.
    static constexpr double widest = 1.3, narrowest_px = 0.5;
    // Lens points of the gathered pictures: of the search, and of its best guesses. The final fit of a first frame has
    // final quality, that of a next frame normal quality, whose noise passes for softness: the lens is 2 % smaller.
    static constexpr int search_points = 32, refine_points = 64;
    // How many of the best guesses of the search are refined, and how many of these at the final size.
    static constexpr std::size_t refined_guesses = 6, final_guesses = 4;
    // How many lenses are compared at most for each of them: in the search; at the final size, to find out which guesses
    // are worth more; in the final fit; for a next frame.
    static constexpr int search_lenses = 30, first_lenses = 8, final_lenses = 40, next_frame_lenses = 8;
    // Fits whose softness differs by this many pixels, as a deviation, are different maxima of the likelihood.
    static constexpr double softness_apart = 0.5;
    // The reach, pixels of CoC: how far from the best lens others are compared. The first three are its values at the
    // beginning of the search, of the final fit and of the fit of a next frame; then its largest value, and the value
    // below which a search ends. A quadratic function is fitted to the lenses within `model_reaches` times the reach.
    // Lenses nearer than `new_share` of it are the same.
    static constexpr double search_reach_px = 1.5, final_reach_px = 0.75, next_reach_px = 0.3,
                            farthest_px = 3, settled_px = 0.15, model_reaches = 2.1, new_share = 0.125;
    // The step of the softness's variance for its derivative, and its range, square pixels. It is negative where a plate
    // is sharper than the gathered picture, which the warp of the views softens a little.
    static constexpr double softness_step = 0.2, least_softness = -0.4, most_softness = 9;
};

} // namespace sparselens
