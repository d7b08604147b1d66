#include "lens/lens_samples.h"

#include "base/random.h"
#include "lens/lens_points.h"

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

} // namespace sparselens
