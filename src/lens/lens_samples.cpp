#include "lens/lens_samples.h"

#include "base/random.h"
#include "lens/lens_points.h"

#include <cmath>

namespace sparselens {

std::vector<LensSample> disc_lens_samples(std::size_t n, double pixel_aspect) {
    std::vector<LensSample> samples;
    // Spiral order is by radius; a low-discrepancy sequence along it keeps lens and pixel position independent.
    std::uint32_t k = 0;
    for (const Imath::V2d &u : spiral_lens_points(int(n))) {
        const Imath::V2d pixel = low_discrepancy_2d(k++, {0.5, 0.5});
        samples.push_back(
            {float(u.x), float(-u.y * pixel_aspect), float(pixel.x - 0.5), float(pixel.y - 0.5), 1});
    }
    return samples;
}

std::vector<LensSample> lens_samples(const Aperture &aperture, std::size_t n, double pixel_aspect) {
    std::vector<LensSample> samples = disc_lens_samples(n, pixel_aspect);
    if (aperture.disc()) {
        const float narrower = float(1 / aperture.shape().squeeze);
        for (LensSample &s : samples) s.x *= narrower;
        return samples;
    }
    if (n == 1) return samples; // the middle
    // The spiral in the unit square: the share within the radius, and the share of a turn.
    const double golden = (3 - std::sqrt(5.0)) / 2;
    for (std::size_t k = 0; k < n; ++k) {
        const double turns = golden * double(k);
        const LensPoint point = aperture.at({(double(k) + 0.5) / double(n), turns - std::floor(turns)});
        LensSample &s = samples[k];
        s.x = float(point.u.x);
        s.y = float(-point.u.y * pixel_aspect);
        s.rgb = point.rgb;
        s.behind = point.behind;
        s.in_front = point.in_front;
    }
    return samples;
}

} // namespace sparselens
