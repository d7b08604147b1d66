#include "warp/mixed/other_views.h"

#include "base/coverage.h"
#include "base/grid.h"
#include "lens/perceptive_depth.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

OtherViews::OtherViews(std::span<const ViewSamples> views, std::span<const ViewMapping> mappings,
                       std::size_t own, double scale)
    : views_(views), mappings_(mappings), own_(own), scale_(scale), rgb_(find_rgb(views[own].channels)),
      alpha_(views[own].alpha()) {}

// The pixel of a view that shows the surface alone, if it does.
std::optional<std::size_t> OtherViews::pixel_of(std::size_t view, const Imath::V2d &in_centre, double depth,
                                                double apart) const {
    const ViewSamples &samples = views_[view];
    const Imath::Box2i &data = samples.windows.data;
    const Imath::V2d seen = mappings_[view].in_view(in_centre, depth / scale_);
    if (!(seen.x >= data.min.x + 1 && seen.x < data.max.x && seen.y >= data.min.y + 1 && seen.y < data.max.y))
        return {};
    const std::size_t pixel = samples.windows.index(int(std::floor(seen.x)), int(std::floor(seen.y))),
                      row = std::size_t(samples.windows.width());
    const auto depth_at = [&](std::size_t i) { return perceptive_depth(scale_, double(samples.z(i))); };
    if (samples.pixel(pixel).empty() || !(std::abs(depth_at(pixel) - depth) < apart)) return {};
    for (const std::size_t line : {pixel - row, pixel, pixel + row})
        for (const std::size_t i : {line - 1, line, line + 1})
            if (!(samples.pixel(i).empty() || depth_at(i) < depth + apart)) return {};
    return is_opaque(alpha_at(samples, alpha_, pixel)) ? std::optional(pixel) : std::nullopt;
}

std::optional<Imath::V3d> OtherViews::colour_behind(const Imath::V2i &pixel, double depth,
                                                    double apart) const {
    const Imath::V2i corner = views_[own_].windows.data.min;
    const Imath::V2d middle(corner.x + pixel.x + 0.5, corner.y + pixel.y + 0.5);
    const Imath::V2d in_centre =
        mappings_[own_].at_infinity(middle) + depth / scale_ * mappings_[own_].parallax(middle);
    Imath::V3d sum(0, 0, 0);
    int count = 0;
    for (std::size_t v = 0; v < views_.size(); ++v) {
        if (v == own_ || views_[v].deep()) continue;
        const auto found = pixel_of(v, in_centre, depth, apart);
        if (!found) continue;
        for (unsigned k = 0; k < 3; ++k) sum[int(k)] += double(views_[v].value(rgb_[k], *found));
        ++count;
    }
    if (count == 0) return {};
    return sum / count;
}

} // namespace sparselens
