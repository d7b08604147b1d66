#include "dof/volumes.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

double shown_depth(double alpha) {
    if (alpha >= 1) return 0;
    if (alpha < 1e-4) return 0.5 - alpha / 12; // the difference below would lose its digits
    return -1 / std::log1p(-alpha) - (1 - alpha) / alpha;
}

Ldi at_shown_depths(Ldi ldi) {
    constexpr std::size_t samples_at_once = std::size_t(1) << 16;
    const std::size_t channel = ldi.alpha();
    const std::vector<float> z_back = std::move(ldi.z_back);
    ldi.z_back.clear();
    if (channel == npos) return ldi;
    parallel_ranges(z_back.size(), samples_at_once, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (!(z_back[i] > ldi.z[i]) || !std::isfinite(z_back[i])) continue;
            const double extent = double(z_back[i]) - double(ldi.z[i]);
            ldi.z[i] += float(shown_depth(double(ldi.values[channel][i])) * extent);
        }
    });
    return ldi;
}

} // namespace sparselens
