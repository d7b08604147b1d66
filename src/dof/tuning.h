// Thresholds of the gathers, with units. Where a measurement exists, the comment quotes it. lab/sweep NAME measures
// what other values cost. What a user chooses is an option (methods.h), with its default there; rules that a device
// shares are in src/kernels.
#pragma once

#include <cstddef>

namespace sparselens {

struct GatherTuning {
    // Pixels of CoC. Tiles that only smaller CoCs reach stay as they were rendered.
    static constexpr float in_focus_px = 0.5f;
    // Pixels of CoC. The CoC of infinity when a lens of radius 0 is gathered.
    static constexpr double sharp_px = 1e-3;

    // Highlights (lens/highlights.h). Pixels of CoC. A lamp with a smaller CoC is compared with the covered samples
    // around it; other lamps are compared with empty pixels too.
    static constexpr float lamp_near_focus_px = 2;
    // A sample this many times as bright as its surroundings (LampTuning) spreads all light that stands out.
    static constexpr float lamp_wholly = 6;
    // The square of brightness over surroundings, for each pixel of the disc. From twice this on, a sample is wholly a
    // lamp; up to it, it is none: its disc cannot be seen, and it adds a thousandth of its surroundings' square to the
    // variance of lens points. Grass with dew, discs of 30000 sub-pixels: this saves a third of the time and
    // loses .03 dB; .01 saves two fifths and loses .9 dB.
    static constexpr float lamp_least_variance = 1e-3f;
    // Share of the samples around that are as bright. Up to this share, a sample can be a lamp.
    static constexpr double lamp_rare = 0.15;
    // From this share on, a sample is not a lamp.
    static constexpr double lamp_common = 0.3;
    // Octaves below a sample's brightness, down to which other samples count as bright as it.
    static constexpr double lamp_octave = 1;
    // The size of a group of highlights, as a share of the CoC. Macro at 1920x1080, focused at 3 m, far behind the
    // objects: 1/16 takes 79 CPU s, 1/8 takes 47, 1/4 takes 31 and 1/2 takes 28 CPU s. Tone mapped, these pictures are
    // 82, 69, 67 and 64 dB from the picture without groups.
    static constexpr float lamp_group_of_coc = 1.0f / 4;
    // Pixels of CoC. Smaller discs are shadowed in cells of the lens.
    static constexpr double lamp_in_cells_px = 3;
    // Pixels of CoC. Up to this CoC, light comes from the square of the sample's pixel.
    static constexpr double lamp_square_to_px = 1;
    // Pixels of CoC. From this CoC on, light comes from the sample's position.
    static constexpr double lamp_point_from_px = 2;
    // Pixels by which light from the square of a pixel reaches farther, at most.
    static constexpr float lamp_square_reach_px = 2;
    // The discs of a lamp along its path (shutter/lamp_paths.h) are this far apart: pixels, or a share of the CoC if
    // that is more; and how many there are at most.
    static constexpr float lamp_step_px = 1, lamp_step_of_coc = 1.0f / 8;
    static constexpr int most_lamp_steps = 256;
    // Share of the aperture. A pixel to which a cat-eye leaves less gets no light from lamps.
    static constexpr double cat_eye_least = 1e-4;

    // Shadows on lamps (lens/highlight_shadows.h). A ratio of depths, the same at any aperture: highlights that are no
    // nearer than this are parts of one lamp.
    static constexpr float one_lamp = 1.1f;
    // Share of the disc's radius. A shadow that the lamps of a group share may be this far off.
    static constexpr double shared_shadow_of_radius = 0.01;
    // Cells of disparity. If a caster is this far in front of a lamp, the shadow of a cell is at most a
    // sixteenth of the disc's radius wide.
    static constexpr float shadow_far_cells = 16;
    // The same in tiles without cells, at normal quality. Macro, five path-traced views: 64 loses .001 dB and takes 7.0
    // CPU s instead of 8.6; 48 loses .02 dB, 32 loses .19 dB and takes 5.0 s. A draft takes shadow_far_cells.
    static constexpr float shadow_farther_cells = 64;
    // The sum of the squared CoCs of wide highlights, for each sample of the picture, from which on coarse casters are
    // made for tiles without cells: they cost as much as the shadows that they save.
    static constexpr double coarse_casters_pay = 4;
    // Disparity. Samples no farther apart share the edge of their footprints fully; from torn_px on they share none.
    static constexpr float footprint_whole_px = 0.75f;
    // Pixels of position, of CoC and of disparity. Footprints are joined if their edges differ from a common
    // straight edge by no more.
    static constexpr float joined_px = 1.0f / 16;
    // Share of one_surface_px. A neighbour no farther away in depth shows the surface fully.
    static constexpr double neighbours_whole = 0.75;

    // Far out of focus (lens/cells.h). The CoC, counted in cells, from which on tiles are gathered in cells. Against
    // 4096 lens points, fence at 1920x1080 and normal quality has 55.0 dB without cells. With cells of 2 x 2 as well,
    // it has 54.0 dB from 8 cells of CoC on, and 51.8 dB from 4 on. The detail that a disc leaves of a chequered wall
    // is as fine as that.
    static constexpr float normal_cells = 8;
    // The same at final quality.
    static constexpr float final_cells = 12;
    // Cells of disparity. Samples of a cell that no lens point moves farther apart become one surface there.
    // Samples that stay apart would cover a part of their cell, which costs more time.
    static constexpr float one_cell = 0.5f;

    // The width and height, in pixels, of the cells in which lamps, brightness and noise are found. Bands of rows begin
    // and end with whole cells (gather_rows.cpp), so that a band has the cells of the whole picture.
    static constexpr int cell_px = 32;

    // What no view saw (lens/fillers.h). How far a mixed colour may lie from the line between the two colours, as a
    // share of their contrast (unmix()).
    static constexpr double filler_mixed = 0.1;

    // What leaves the frame (lens/beyond/frame_extension.h). Pixels of the picture along the border, beside a pixel,
    // that count as its surroundings.
    static constexpr int border_along = 32;
    // Pixels of the picture, inwards from the border, that tell how far something continues. Bands of rows include as
    // many rows at the border (gather_rows.cpp).
    static constexpr int border_inwards = 96;
    // Pixels of the LDI: samples continue for a multiple of this (border_reach.h). When the focus on fence at 1920x1080
    // moves from 4 to 5 in 24 frames, only one frame gathers other samples than the frame before it.
    static constexpr int border_step = 8;

    // Sharpening (lens/sharpen.h). This quantile of a block's detail is its noise, because the calmer part shows only
    // noise.
    static constexpr double noise_quantile = 0.3;
    // Detail of this many times the noise is sharpened by half.
    static constexpr double noise_times = 5;
    // Pixels of CoC, beyond which the blur of interpolation does not show (footprints/interpolation_blur.h).
    static constexpr double interpolated_px = 4;

    // Grain (grain.h). Groups of blocks, at most, and blocks of each, at least. The quantile of their variances that is
    // noise, and the part of its variance that noise alone has there (chi squared of 68 degrees of freedom, as many as
    // 256 pixels have of which neighbours are alike). Pixels that a pixel of radius adds to a disc at its rim. The variance
    // that an eye does not see, squares of the steps that a display of 8 bits has.
    static constexpr std::size_t grain_groups = 16, grain_group_least = 32;
    static constexpr double grain_quantile = 0.1, grain_rim = 1.5, grain_shown = 0.25;
    static constexpr float grain_of_quantile = 0.79f;

    // The selective gather (selective/splats.h). The width of a depth bin, pixels of CoC: 0.25 gains nothing, 1 loses
    // 0.5 dB on thin blades of grass.
    static constexpr double bin_px = 0.5;
    // Pixels of CoC. Beyond it, bins are wider: 1/64 of the CoC.
    static constexpr double bins_linear_to_px = 32;

    // Whether light that leaves the frame shows (border_reach.h). Coverage: the blur of fainter samples is not seen.
    static constexpr float border_counts = 0.5f;
    // Pixels of CoC. A lamp with a smaller CoC does not show as a disc.
    static constexpr float border_least_px = 2;
};

} // namespace sparselens
