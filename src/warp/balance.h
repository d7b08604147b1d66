// The weights of the samples of a surface if views of it are missing.
//
// Views from opposite sides of the lens see a surface at opposite offsets from the middle of a pixel, so the mean of
// all of them lies near the middle. Where some views were not rendered (plan/plan.h), the mean of the others does not:
// adjacent pixels, with a view and without it, are shifted against each other, which blurs what is in focus. There the
// samples get the weights of the best linear unbiased estimate of the colour in the middle: a sample of weight w has
// noise of variance 1 / w, and the colour's gradient is unknown, `gradient_to_noise` per pixel along each axis.
#pragma once

#include "kernels/warp_rules.h"
#include "warp/reprojected_views.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace sparselens {

// Whether the view was not rendered where it would see that position.
inline bool is_missing(const ReprojectedViews &views, std::size_t view, const Imath::V2d &place,
                       double inverse_z) {
    const Windows &windows = views.samples(view).windows;
    const ViewMapping &mapping = views.reprojection(view).mapping();
    const Imath::V2d seen = mapping.in_view(place, inverse_z);
    // Pixels beyond the centre view's frame in that direction are not missing, however the view is framed.
    const Imath::V2d towards = mapping.at_infinity(seen);
    const Imath::Box2i &frame = views.samples(0).windows.data;
    if (!kernels::lies_in(towards.x, frame.min.x, frame.max.x)) return false;
    if (!kernels::lies_in(towards.y, frame.min.y, frame.max.y)) return false;
    const Imath::V2i pixel(int(std::floor(seen.x)), int(std::floor(seen.y)));
    return !windows.data.intersects(pixel) ||
           views.samples(view).pixel(windows.index(pixel.x, pixel.y)).empty();
}

// Whether some view has no pixel where it would see the surface of these samples, because it was not rendered there.
inline bool some_view_is_missing(const ReprojectedViews &views, std::span<const ViewSample> samples) {
    const ViewSample &first = samples[0];
    const Imath::V2d place(first.x + 0.5 + double(first.dx), first.y + 0.5 + double(first.dy));
    for (std::size_t view = 1; view < views.size(); ++view) {
        const bool is_there = std::ranges::find(samples, view, &ViewSample::view) != samples.end();
        if (!is_there && is_missing(views, view, place, double(first.inverse_z))) return true;
    }
    return false;
}

// Returns the samples with these weights, up to a common factor. There must be at least one.
inline std::vector<ViewSample> balanced(std::span<const ViewSample> samples) {
    kernels::Offsets offsets = kernels::no_offsets();
    for (const ViewSample &s : samples) kernels::add_offset(offsets, s.weight, double(s.dx), double(s.dy));
    const double by_x = kernels::balance_x(offsets), by_y = kernels::balance_y(offsets);
    std::vector<ViewSample> result(samples.begin(), samples.end());
    for (ViewSample &s : result) s.weight *= kernels::balanced_share(double(s.dx), double(s.dy), by_x, by_y);
    return result;
}

} // namespace sparselens
