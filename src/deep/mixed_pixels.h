// Pixels that mix two surfaces: their shares in the colour, and their depth.
#pragma once

#include "deep/ldi.h"
#include "view/view.h"

#include <Imath/ImathVec.h>

#include <cstddef>
#include <optional>
#include <string>

namespace sparselens {

// Computes the shares of two colours in a third: c = a F + (1 - a) B.
struct Mix {
    double share;    // a, of F
    double residual; // distance of c from the line through F and B, as a share of their contrast |F - B|
};

// A smaller share of a pixel is not worth a sample.
inline constexpr double least_mixed_share = 0.02;

// The expected a: `share`, with its weight against the colours (a share of their size), and the bounds of a.
struct MixPrior {
    double weight, share, least, most;
};
inline constexpr MixPrior no_prior{0, 0, 0, 1}, mostly_b{0.05, 0, 0, 0.5},
    mostly_f{0.05, 1, 0.5, 1}; // expected: not mixed

// Solves for a by least squares. The rest of c without B is light, so (1 - a) B exceeds c in no channel; a is raised
// until this holds. Returns nothing if a is then more than the prior allows, if F and B are too similar, if c is
// farther from the line than largest_residual, if the share of F or B is negligible, or if a colour is NaN.
std::optional<Mix> unmix(const Imath::V3d &c, const Imath::V3d &f, const Imath::V3d &b, const MixPrior &prior,
                         double largest_residual);

inline Imath::V3d rgb(const Imath::V4d &rgba) { return {rgba[0], rgba[1], rgba[2]}; }

// A mixture with a veil behind, whose density changes from pixel to pixel: c = a F + (1 - a) k B. Colours are RGBA, F
// is opaque, and B covers a part of its pixel.
struct VeilMix {
    double share;    // a, of F
    double density;  // k: the veil covers k times as much as B
    double residual; // as above, with k B for B
};

// Solves for a and k: the coverages add up to that of c exactly, the colours by least squares. As coverage tells more
// than the depth of the pixel, there is no prior. Returns nothing where unmix() would.
std::optional<VeilMix> unmix_veil(const Imath::V4d &c, const Imath::V4d &f, const Imath::V4d &b,
                                  double largest_residual);

// Corrects the depth of pixels on the edge of a surface, where the renderer wrote a depth at which the pixel shows
// nothing.
//
// A renderer takes the depth of such a pixel from one of its samples, or filters it like a colour:
//
//   - The pixel is partly covered (0 < A < 1), and its depth is that of the nothing beside the surface: it is infinite,
//     or more than 16 times the depth of each more covered pixel around it. Or the pixel lies beside one that shows
//     nothing, and its depth is A times the depth of a pixel around it, the mean of a surface and of zeros. The depth
//     is replaced by that of the pixel around it that explains it best: its colour without coverage is similar, and it
//     is well covered. "Around" means the eight neighbours, or if they do not help the 24 within two pixels. A strand
//     over nothing, thinner than a pixel, shows its depth in few pixels; they pass it on, up to 8 pixels farther.
//   - The pixel is opaque, and its depth and its colour mix two pixels on opposite sides in the same proportion, at a
//     step and not on a slope. It takes the depth of the surface that it shows more of. This is done only in a picture
//     with many such edges, because then its depth is filtered. In other pictures such edges are chance.
//
// Colour and coverage stay, so that what lies behind a partly covered pixel shows.
struct RepairedEdges {
    std::size_t count = 0; // depths that were replaced
    bool filtered = false; // opaque pixels among them: the depth is filtered like a colour
};

// Depths are planar, > 0 up to inf; colours are premultiplied, and all values valid (see
// sanitize.h). An Ldi must have one sample in each pixel.
RepairedEdges repair_edge_depths(View &view);
RepairedEdges repair_edge_depths(Ldi &ldi);

// The note of a reader about replaced depths.
std::string edge_note(std::size_t repaired);

} // namespace sparselens
