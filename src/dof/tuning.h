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

    // What leaves the frame (lens/beyond/border.h). Pixels on either side along the border that are around one.
    static constexpr int border_along = 32;
    // Pixels inwards that tell how far something goes on: no farther than bands of rows reach (gather_rows.cpp).
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
