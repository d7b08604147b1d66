#include "gpu/warp/warp_frame.h"

#include "base/parallel.h"
#include "kernels/warp_rules.h"
#include "warp/reprojected_views.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens::gpu {

namespace {

struct Rows { // of a view, from the top of its data window
    std::size_t first, end;
};

// The rows of a view that show something in the box or next to it, at depths from 1 / inverse_z on: the samples that
// fall into the box, and those that the votes look at. Positions in the view are linear in p, and change in one direction with 1 / z, so the
// extremes lie at the corners.
Rows rows_needed(const ReprojectedViews &views, std::size_t v, const Imath::Box2i &box, double inverse_z) {
    const ViewMapping &mapping = views.reprojection(v).mapping();
    const Imath::Box2i &data = views.samples(v).windows.data;
    const auto height = std::size_t(views.samples(v).windows.height());
    double top = std::numeric_limits<double>::infinity(), bottom = -top;
    for (const double y : {double(box.min.y), box.max.y + 1.0})
        for (const double depth : {0.0, inverse_z}) {
            const double seen = mapping.in_view({box.min.x + 0.5, y}, depth).y;
            if (!std::isfinite(seen)) return {0, height}; // behind the camera
            top = std::min(top, seen);
            bottom = std::max(bottom, seen);
        }
    const auto row = [&](double y) { return std::clamp(y - data.min.y, 0.0, double(height)); };
    return {std::size_t(row(std::floor(top) - 1)), std::size_t(row(std::floor(bottom) + 2))};
}

warp_kernel::View view_of(const ReprojectedViews &views, std::size_t v) {
    const ViewMapping &mapping = views.reprojection(v).mapping();
    const Imath::V2d offset = mapping.at_infinity({0, 0}), step = mapping.parallax({0, 0});
    const Imath::Box2i &data = views.samples(v).windows.data;
    return {mapping.unzoom(), mapping.approach(), offset.x,   offset.y,   step.x, step.y, data.min.x,
            data.min.y,       data.max.x,         data.max.y, data.min.y, 0,      0,      0};
}

} // namespace

double largest_inverse_z(const ReprojectedViews &views) {
    constexpr float infinity = std::numeric_limits<float>::infinity(),
                    normal = std::numeric_limits<float>::min(); // devices may take less as 0
    std::vector<float> nearest(views.size(), infinity), farthest(views.size(), 1);
    parallel_for(views.size(), [&](std::size_t v) {
        const ViewSamples &view = views.samples(v);
        for (std::size_t p = 0; p < view.windows.pixels(); ++p)
            for (const std::uint64_t i : view.pixel(p)) {
                nearest[v] = std::min(nearest[v], view.z(i));
                if (view.z(i) < infinity) farthest[v] = std::max(farthest[v], view.z(i));
            }
    });
    const float least = *std::ranges::min_element(nearest), most = *std::ranges::max_element(farthest);
    return least < normal || 1 / double(most) < normal ? std::numeric_limits<double>::infinity()
                                                       : 1 / double(least);
}

WarpStripe make_stripe(const WarpScene &scene, const Imath::Box2i &box, double inverse_z) {
    WarpStripe stripe;
    stripe.box = box;
    for (std::size_t v = 0; v < scene.views.size(); ++v) {
        const ViewSamples &samples = scene.views.samples(v);
        const auto width = std::size_t(samples.windows.width());
        const Rows rows = rows_needed(scene.views, v, box, inverse_z);
        warp_kernel::View view = view_of(scene.views, v);
        view.first_row += int(rows.first);
        view.rows = int(rows.end - rows.first);
        view.begins = std::uint32_t(stripe.begins);
        const WarpStripe::Slice slice{rows.first, rows.end, samples.count(rows.first, rows.end)};
        stripe.views.push_back(view);
        stripe.slices.push_back(slice);
        stripe.begins += (rows.end - rows.first) * width + 1;
        stripe.samples += slice.samples;
    }
    return stripe;
}

std::size_t buffer_bytes(const WarpScene &scene, const WarpStripe &stripe) {
    const std::size_t of_sample = std::max(4 * (4 + scene.layout.channels.size()), std::size_t{16}),
                      pixels = Grid(stripe.box).size();
    return std::max({of_sample * stripe.samples, 4 * stripe.begins, 4 * (pixels + 1)});
}

warp_kernel::Frame frame_of(const WarpScene &scene, const WarpStripe &stripe, std::uint32_t most_in_pixel) {
    warp_kernel::Frame frame{};
    frame.tolerance = scene.tolerance;
    frame.inverse_scale = 1 / scene.scale;
    frame.motion_unit = kernels::motion_unit(scene.across);
    frame.first_x = stripe.box.min.x;
    frame.first_y = stripe.box.min.y;
    frame.width = Grid(stripe.box).width();
    frame.height = Grid(stripe.box).height();
    frame.views = std::uint32_t(stripe.views.size());
    frame.samples = std::uint32_t(stripe.samples);
    frame.channels = std::uint32_t(scene.layout.channels.size());
    const std::size_t alpha = find_channel(scene.layout.channels, "A");
    frame.alpha = alpha == npos ? warp_kernel::none : std::uint32_t(alpha);
    for (const std::size_t colour : find_rgb(scene.layout.channels))
        if (colour != npos) frame.colours[frame.colours[3]++] = std::uint32_t(colour);
    frame.rules = scene.averages ? warp_kernel::averages : 0;
    if (scene.focus) {
        frame.rules |= std::isinf(scene.focus->focus)
                           ? warp_kernel::focus_known | warp_kernel::focus_at_infinity
                           : warp_kernel::focus_known;
        frame.focus_scale = scene.focus->radius * scene.focus->focal_px;
        frame.focus = scene.focus->focus;
    }
    frame.most_in_pixel = most_in_pixel;
    return frame;
}

} // namespace sparselens::gpu
