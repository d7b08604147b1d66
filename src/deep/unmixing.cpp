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

} // namespace sparselens
