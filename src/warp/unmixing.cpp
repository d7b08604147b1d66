#include "warp/unmixing.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {
constexpr double least_contrast = 0.1; // between F and B, as a share of their own size
constexpr double prior = 0.05;         // weight of "not mixed" against the colours, as a share of their size
constexpr double least_share = 0.02;   // less than this of a pixel is not worth a sample
} // namespace

std::optional<Mix> unmix(const Rgb &c, const Rgb &f, const Rgb &b, bool mostly_b, double largest_residual) {
    const Rgb contrast = f.minus(b), offset = c.minus(b);
    const double size = 0.5 * (f.dot(f) + b.dot(b)), distance = contrast.dot(contrast);
    if (distance <= least_contrast * least_contrast * size) return {};
    const double doubt = prior * prior * size, unmixed = mostly_b ? 0 : 1;
    double share = (offset.dot(contrast) + doubt * unmixed) / (distance + doubt);
    share = mostly_b ? std::clamp(share, 0.0, 0.5) : std::clamp(share, 0.5, 1.0);
    Rgb rest = offset;
    for (std::size_t k = 0; k < 3; ++k) rest.v[k] -= share * contrast.v[k];
    const double residual = std::sqrt(rest.dot(rest) / distance);
    if (residual > largest_residual) return {};
    for (std::size_t k = 0; k < 3; ++k)
        if ((1 - share) * b.v[k] > c.v[k]) share = 1 - std::max(c.v[k], 0.0) / b.v[k];
    if (!(share >= least_share && share <= 1 - least_share)) return {}; // nor where a colour is no number
    return Mix{share, residual};
}

} // namespace sparselens
