#include "deep/unmixing.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {
constexpr double least_contrast = 0.1; // between F and B, as a share of their own size
} // namespace

std::optional<Mix> unmix(const Imath::V3d &c, const Imath::V3d &f, const Imath::V3d &b, const MixPrior &prior,
                         double largest_residual) {
    const Imath::V3d contrast = f - b, offset = c - b;
    const double size = 0.5 * (f.dot(f) + b.dot(b)), distance = contrast.dot(contrast);
    if (distance <= least_contrast * least_contrast * size) return {};
    const double doubt = prior.weight * prior.weight * size;
    double share = std::clamp((offset.dot(contrast) + doubt * prior.share) / (distance + doubt), prior.least,
                              prior.most);
    const Imath::V3d rest = offset - share * contrast;
    const double residual = std::sqrt(rest.dot(rest) / distance);
    if (residual > largest_residual) return {};
    for (int k = 0; k < 3; ++k)
        if ((1 - share) * b[k] > c[k]) share = 1 - std::max(c[k], 0.0) / b[k];
    if (!(share >= least_mixed_share && share <= 1 - least_mixed_share)) return {}; // also if a colour is NaN
    return Mix{share, residual};
}

std::optional<VeilMix> unmix_veil(const Imath::V4d &c, const Imath::V4d &f, const Imath::V4d &b,
                                  double largest_residual) {
    // With a = c.alpha - m b.alpha and m = (1 - a) k: what c has more than F of that coverage is m times `contrast`.
    const Imath::V3d contrast = rgb(b) - b[3] * rgb(f), offset = rgb(c) - c[3] * rgb(f);
    const double size = 0.5 * (b[3] * b[3] * rgb(f).dot(rgb(f)) + rgb(b).dot(rgb(b))),
                 distance = contrast.dot(contrast);
    if (distance <= least_contrast * least_contrast * size) return {};
    double m = std::clamp(offset.dot(contrast) / distance, 0.0, c[3] / b[3]);
    for (int k = 0; k < 3; ++k)
        if (m * b[k] > c[k]) m = std::max(c[k], 0.0) / b[k];
    const double share = c[3] - m * b[3], density = m / (1 - share);
    if (!(share >= least_mixed_share && share <= 1 - least_mixed_share)) return {}; // also if a colour is NaN
    const double residual = (offset - m * contrast).length() / (rgb(f) - density * rgb(b)).length();
    if (!(residual <= largest_residual)) return {};
    return VeilMix{share, density, residual};
}

} // namespace sparselens
