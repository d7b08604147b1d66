// The thresholds of the gathers, each in its unit, with what was measured of it; of what says nothing, nothing was.
// lab/sweep NAME measures what other values cost. What a user chooses is an option (methods.h), with a default there; rules that a
// device shares are in src/kernels. "Perceptive" is of perceptive depth, in pixels.
#pragma once

namespace sparselens {

struct GatherTuning {
    // Pixels of CoC: what has no larger one is as it was rendered.
    static constexpr float in_focus_px = 0.5f;
    // Pixels of CoC that infinity has, seen by a lens of radius 0.
    static constexpr double sharp_px = 1e-3;

    // Highlights (lens/highlights.h). Pixels of CoC: of less, lamps stand out of what covers something, not of nothing.
    static constexpr float lamp_near_focus_px = 2;
    // Times the surroundings (LampTuning), from which on all that stands out is spread.
    static constexpr float lamp_wholly = 6;
    // Shares of what is around that is as bright: of a lamp, ...
    static constexpr double lamp_rare = 0.15;
    // ... and of none.
    static constexpr double lamp_common = 0.3;
    // Octaves below a sample's brightness, to which others count as bright as half.
    static constexpr double lamp_octave = 1;
    // The size of a group of highlights, of the CoC. A street at night at 1280x720 and four times its lens, 1/32: 18.8 CPU s, 1/16:
    // 15.1, 61 dB apart, 1/8: 17.9, as more lamps then stand between what shades them.
    static constexpr float lamp_group_of_coc = 1.0f / 16;
    // Pixels of CoC: discs that are smaller are shadowed in cells.
    static constexpr double lamp_in_cells_px = 3;
    // Pixels of CoC: up to this, light comes from a sample's square, ...
    static constexpr double lamp_square_to_px = 1;
    // ... and from this on, from its place.
    static constexpr double lamp_point_from_px = 2;
    // Of the aperture: what a cat-eye leaves less of is dark.
    static constexpr double cat_eye_least = 1e-4;

    // Shadows of what is before lamps (lens/highlight_shadows.h). Times as near: parts of one lamp, at any aperture.
    static constexpr float one_lamp = 1.1f;
    // Of the disc's radius: how far off the shadow may be that the lamps of a group share.
    static constexpr double shared_shadow_of_radius = 0.02;
    // Cells of perceptive depth: so far before a lamp, a cell's shadow is a sixteenth of the disc's radius wide or less.
    static constexpr float shadow_far_cells = 16;
    // Perceptive: surfaces no farther apart are one altogether for a footprint; from torn_px on they are two.
    static constexpr float footprint_whole_px = 0.75f;
    // Pixels of place and of CoC, perceptive: footprints whose edges are no farther off a common straight one are one.
    static constexpr float joined_px = 1.0f / 16;
    // Of one_surface_px: what is no farther away shows the surface altogether.
    static constexpr double neighbours_whole = 0.75;

    // Far out of focus (lens/cells.h). Cells of CoC from which on pixels are gathered in cells. Against 4096 lens points, fence at
    // 1920x1080 has 55.0 dB without cells, at normal quality; with cells of 2 x 2 as well and from 8 cells of CoC on 54.0, from 4
    // on 51.8. What a disc leaves of a chequered wall is as fine as that.
    static constexpr float normal_cells = 8;
    // The same at final quality.
    static constexpr float final_cells = 12;
    // Cells of perceptive depth: what some lens point moves apart by no more is one surface in a cell. What stayed apart would cover
    // a part of its cell, which costs more.
    static constexpr float one_cell = 0.5f;

    // What no view saw (lens/fillers.h). Of a colour that is a mixture, how far it lies beside the line between two (unmix()).
    static constexpr double filler_mixed = 0.1;

    // What leaves the frame (lens/beyond/border.h). Pixels of the picture on either side along the border that are around one.
    static constexpr int border_along = 32;
    // Pixels of the picture inwards that tell how far something goes on; bands of rows have as many beside them (gather_rows.cpp).
    static constexpr int border_inwards = 96;

    // Sharpening (lens/sharpen.h). This quantile of the detail of a block is its noise: the calmer part shows that alone.
    static constexpr double noise_quantile = 0.3;
    // Times the noise: detail of so much is sharpened by half.
    static constexpr double noise_times = 5;
    // Pixels of CoC: beyond, the blur of interpolation does not show (footprints/interpolation_blur.h).
    static constexpr double interpolated_px = 4;

    // The selective gather (selective/blend.h). Pixels of CoC of a bin: 0.25 gains nothing, 1 loses 0.5 dB on thin blades of grass.
    static constexpr double bin_px = 0.5;
    // Pixels of CoC; beyond, bins widen: 1/64 of the CoC.
    static constexpr double bins_linear_to_px = 32;

    // Whether light that leaves the frame shows (border_reach.h). Of coverage: fainter samples blur unseen.
    static constexpr float border_counts = 0.5f;
    // Pixels of CoC: a lamp of less is no disc.
    static constexpr float border_least_px = 2;
};

} // namespace sparselens
