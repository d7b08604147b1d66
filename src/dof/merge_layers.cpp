#include "dof/merge_layers.h"

#include "base/parallel.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "deep/cluster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sparselens {

bool can_merge_layers(const Ldi &ldi) {
    return ldi.alpha() != npos && std::ranges::none_of(ldi.channels, is_in_matte) &&
           by_coverage(ldi).size() == 1;
}

Ldi merge_layers(Ldi ldi, double scale, double tolerance) {
    if (!can_merge_layers(ldi)) return ldi;
    ldi.weight.clear();
    return cluster_for_gather(at_shown_depths(std::move(ldi)), scale, tolerance);
}

double shown_depth(double alpha) {
    if (alpha >= 1) return 0;
    if (alpha < 1e-4) return 0.5 - alpha / 12; // the difference below would lose its digits
    return -1 / std::log1p(-alpha) - (1 - alpha) / alpha;
}

Ldi at_shown_depths(Ldi ldi) {
    constexpr std::size_t samples_at_once = std::size_t(1) << 16;
    const std::size_t alpha = ldi.alpha();
    parallel_ranges(ldi.z_back.size(), samples_at_once, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const double extent = double(ldi.z_back[i]) - double(ldi.z[i]);
            if (!(extent > 0) || !std::isfinite(extent)) continue;
            const auto farther = float(shown_depth(double(alpha_at(ldi, alpha, i))) * extent);
            ldi.z[i] += farther;
            ldi.z_back[i] = std::numeric_limits<float>::infinity();
            if (!ldi.image_z.empty()) ldi.image_z[i] += farther;
        }
    });
    return ldi;
}

} // namespace sparselens
