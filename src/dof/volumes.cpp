#include "dof/volumes.h"

#include "base/parallel.h"
#include "deep/build.h"

#include <cmath>
#include <utility>

namespace sparselens {

double shown_depth(double alpha) {
    if (alpha >= 1) return 0;
    if (alpha < 1e-4) return 0.5 - alpha / 12; // the difference below would lose its digits
    return -1 / std::log1p(-alpha) - (1 - alpha) / alpha;
}

Ldi at_shown_depths(Ldi ldi) {
    constexpr std::size_t samples_at_once = std::size_t(1) << 16;
    const std::size_t alpha = ldi.alpha();
    const std::vector<float> z_back = std::move(ldi.z_back);
    ldi.z_back.clear();
    parallel_ranges(z_back.size(), samples_at_once, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const double extent = double(z_back[i]) - double(ldi.z[i]);
            if (!(extent > 0) || !std::isfinite(extent)) continue;
            const auto farther = float(shown_depth(double(alpha_at(ldi, alpha, i))) * extent);
            ldi.z[i] += farther;
            if (!ldi.optical.empty()) ldi.optical[i] += farther;
        }
    });
    return ldi;
}

} // namespace sparselens
