// The weights of the samples of a surface where views of it are missing.
//
// Views from opposite sides of the lens see a surface at opposite offsets from the middle of a pixel, so that the mean
// of all of them stands near the middle. Where views were rendered in part (plan/plan.h), the mean of those that are there
// does not: pixels side by side, with such a view and without, are shifted against each other, which blurs what is in
// focus. There the samples get the weights of the best linear unbiased estimate of the colour in the middle: a sample
// of weight w has noise of variance 1 / w, and the colour's gradient is unknown, `gradient_to_noise` a pixel along
// each axis.
#pragma once

#include "warp/reprojected_views.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace sparselens {

inline constexpr double gradient_to_noise = 8; // gains 0.1 to 0.2 dB on fence and yard from 5 to 17

// Whether the view was not rendered where it would see that place.
inline bool is_missing(const ReprojectedViews &views, std::size_t view, const Imath::V2d &place,
                       double inverse_z) {
    const Windows &windows = views.samples(view).windows;
    const ViewMapping &mapping = views.reprojection(view).mapping();
    const Imath::V2d seen = mapping.in_view(place, inverse_z);
    // What the centre view has beyond its frame in that direction is not missing, however the view is framed.
    const Imath::V2d towards = mapping.at_infinity(seen);
    const Imath::Box2i &frame = views.samples(0).windows.data;
    if (!(towards.x >= frame.min.x && towards.x < frame.max.x + 1.0)) return false;
    if (!(towards.y >= frame.min.y && towards.y < frame.max.y + 1.0)) return false;
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

// The samples with those weights, up to a common factor; none has less than a hundredth of its own. They are not empty.
// For weights w and offsets x: w (1 - x . b), b = (1 / g^2 + sum of w x x^T)^-1 (sum of w x).
inline std::vector<ViewSample> balanced(std::span<const ViewSample> samples) {
    constexpr double least_share = 0.01;
    constexpr double not_known = 1 / (gradient_to_noise * gradient_to_noise);
    double xx = not_known, xy = 0, yy = not_known, x = 0, y = 0;
    for (const ViewSample &s : samples) {
        const double dx = double(s.dx), dy = double(s.dy);
        xx += s.weight * dx * dx;
        xy += s.weight * dx * dy;
        yy += s.weight * dy * dy;
        x += s.weight * dx;
        y += s.weight * dy;
    }
    const double determinant = xx * yy - xy * xy; // > 0: the matrix is positive definite
    const double bx = (yy * x - xy * y) / determinant, by = (xx * y - xy * x) / determinant;
    std::vector<ViewSample> result(samples.begin(), samples.end());
    for (ViewSample &s : result) s.weight *= std::max(least_share, 1 - double(s.dx) * bx - double(s.dy) * by);
    return result;
}

} // namespace sparselens
