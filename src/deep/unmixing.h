// Computes the shares of two colours in a third: c = a F + (1 - a) B.
#pragma once

#include <Imath/ImathVec.h>

#include <optional>

namespace sparselens {

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
    mostly_f{0.05, 1, 0.5, 1}; // these: not mixed

// Solves for a by least squares. The rest of c without B is light, so (1 - a) B exceeds c in no channel. Returns
// nothing if F and B are too similar, if c is farther from the line than largest_residual, if the share of F or B is
// negligible, or if a colour is NaN.
std::optional<Mix> unmix(const Imath::V3d &c, const Imath::V3d &f, const Imath::V3d &b, const MixPrior &prior,
                         double largest_residual);

inline Imath::V3d rgb(const Imath::V4d &rgba) { return {rgba[0], rgba[1], rgba[2]}; }

// A mixture with a veil behind, whose density changes from pixel to pixel: c = a F + (1 - a) k B. Colours are RGBA, F is
// opaque, and B covers a part of its pixel.
struct VeilMix {
    double share;    // a, of F
    double density;  // k: the veil covers k times as much as B
    double residual; // as above, with k B for B
};

// Solves for a and k: the coverages add up to that of c exactly, the colours by least squares. As coverage tells more
// than the depth of the pixel, there is no prior. Returns nothing where unmix() would.
std::optional<VeilMix> unmix_veil(const Imath::V4d &c, const Imath::V4d &f, const Imath::V4d &b,
                                  double largest_residual);

} // namespace sparselens
