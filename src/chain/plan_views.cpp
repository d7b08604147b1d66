#include "chain/plan_views.h"

#include "chain/notices.h"
#include "chain/take_moments.h"
#include "deep/checks/view_warnings.h"
#include "io/exr/exr_header.h"
#include "io/moment_files.h"
#include "plan/noise.h"
#include "plan/plan.h"
#include "view/view_mapping.h"

#include <algorithm>
#include <numeric>

namespace sparselens {

namespace {

// The noise of one render of all rays through the lens: from what the lens mixes, and from the light, whose noise the
// centre view shows. `lens` and `across` are those of the plan.
double noise_of_all(const OpenedView &centre, ThinLens lens, const PlanOptions &options, int rays) {
    const Image &image = centre.view.image;
    const auto &z = centre.view.z;
    const double mixed = noise_of_rays(image, z, lens, options.across, rays);
    lens.radius = 0; // the noise of each pixel by itself
    const std::vector<double> light = noise_in_lens_picture(image, z, lens, options.noise);
    const double samples = render_samples(centre.header).value_or(1);
    return mixed + std::accumulate(light.begin(), light.end(), 0.0) / double(light.size()) * samples / rays;
}

} // namespace

PlannedViews plan_views(const OpenedView &centre, PlanOptions options, const LensValues &lens,
                        std::optional<int> supersample, std::optional<int> rays, Progress &progress,
                        const Notify &notify) {
    PlannedViews planned;
    planned.camera = camera_with_options(lens, centre.camera);
    if (supersample) planned.camera.supersample = supersample;
    options.across = planned.camera.supersample.value_or(1);
    const Windows &windows = centre.view.image.windows;
    planned.setting = {centre.view.name, windows, resolve_lens(planned.camera, windows), options.margin,
                       options.across};
    notify_warnings(notify, picture_warnings(centre.view, {centre.depth, centre.depth_filtered,
                                                           planned.camera, centre.unpremultiplied}));
    planned.plan = make_plan(centre.view, planned.setting.lens, options, progress);
    if (rays)
        planned.setting.division = divide_rays(*rays, int(planned.plan.views.size()) + 1,
                                               std::max(options.across, planned.plan.supersample),
                                               noise_of_all(centre, planned.setting.lens, options, *rays));
    return planned;
}

namespace {

// The part of the shutter's time between two moments: as the files state it, else the files are all moments.
double part_between(const OpenedView &first, const OpenedView &last, std::size_t moments) {
    const auto one = stated_moment(first.header), other = stated_moment(last.header);
    if (one && other && one->moments == other->moments && other->moment > one->moment)
        return double(other->moment - one->moment) / other->moments;
    return double(moments - 1) / double(moments);
}

} // namespace

std::optional<MomentsNeed> plan_moments(const OpenedView &first, const OpenedView &last, std::size_t moments,
                                        const PlannedViews &planned, const LensValues &lens) {
    const View &view = first.view;
    const Windows &windows = view.image.windows;
    require_same_size({view.name, windows}, {last.view.name, last.view.image.windows});
    const auto camera = camera_motion(camera_with_options(lens, first.camera),
                                      camera_with_options(lens, last.camera), windows);
    const auto expected = [&](const Imath::V2i &pixel) {
        const Imath::V2d middle = Imath::V2d(pixel) + Imath::V2d(0.5);
        const double z = double(view.z[windows.index(pixel)]);
        return camera && z > 0 ? camera->moved(middle, z) - middle : Imath::V2d(0);
    };
    return moments_needed(view, last.view, planned.setting.lens, expected, part_between(first, last, moments),
                          planned.setting.across);
}

} // namespace sparselens
