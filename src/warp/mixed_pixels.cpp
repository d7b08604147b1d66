#include "warp/mixed_pixels.h"

#include "base/coverage.h"
#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

// Calls visit(position in the centre view, 1 / z) for each part that covers only some of its pixel.
template <typename Visit>
void for_each_partial(const PlacedView &view, const Visit &visit) {
    const ViewSamples &samples = *view.samples;
    const std::size_t alpha = samples.alpha();
    for (std::size_t p = 0; p < samples.windows.pixels(); ++p)
        for (const std::uint64_t i : samples.pixel(p)) {
            const float covers = alpha_at(samples, alpha, i);
            if (!samples.is_part(i) || !(covers > 0) || is_opaque(covers)) continue;
            const Imath::V2d middle = Imath::V2d(samples.windows.pixel(p)) + Imath::V2d(0.5);
            const double inverse_z = 1 / double(samples.z(i));
            visit(view.mapping->at_infinity(middle) + view.mapping->parallax(middle) * inverse_z, inverse_z);
        }
}

// Marks the pixels under a square of one pixel around a position, at most four, unless they show something nearer.
void mark(const ViewSamples &view, const Imath::V2d &place, double inverse_z, double tolerance,
          std::vector<bool> &mixed) {
    if (!(std::abs(place.x) < 1e9 && std::abs(place.y) < 1e9)) return;
    const int x = int(std::floor(place.x - 0.5)), y = int(std::floor(place.y - 0.5));
    for (int v = y; v <= y + 1; ++v)
        for (int u = x; u <= x + 1; ++u) {
            if (!view.windows.data.intersects(Imath::V2i(u, v))) continue;
            const std::size_t pixel = view.windows.index(u, v);
            if (inverse_z > 1 / double(view.z(pixel)) - tolerance) mixed[pixel] = true;
        }
}

} // namespace

std::vector<std::vector<bool>> find_mixed_pixels(std::span<const PlacedView> views, double tolerance) {
    std::vector<std::vector<bool>> mixed(views.size());
    parallel_for(views.size(), [&](std::size_t v) {
        const PlacedView &flat = views[v];
        if (flat.samples->deep()) return;
        mixed[v].resize(flat.samples->windows.pixels());
        for (const PlacedView &deep : views)
            if (deep.samples->deep())
                for_each_partial(deep, [&](const Imath::V2d &place, double inverse_z) {
                    mark(*flat.samples, flat.mapping->in_view(place, inverse_z), inverse_z, tolerance,
                         mixed[v]);
                });
    });
    return mixed;
}

} // namespace sparselens
