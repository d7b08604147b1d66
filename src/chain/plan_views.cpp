#include "chain/plan_views.h"

#include "base/error.h"
#include "chain/take_moments.h"
#include "deep/checks/view_warnings.h"
#include "io/exr/exr_header.h"
#include "io/moment_files.h"
#include "lens/lens_points.h"
#include "plan/noise.h"
#include "view/view_mapping.h"

#include <fmt/format.h>

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

UsdViews views_of_shot(const ShotRequest &request, const Notify &notify) {
    const std::optional<double> frame = request.camera.frame;
    const UsdCameras usd = read_usd_cameras(request.camera.file, frame);
    const UsdCamera &camera = camera_called(usd, request.camera.name);
    const std::optional<Imath::V2i> size = request.size ? request.size : usd.resolution;
    if (!size)
        throw UsageError(fmt::format(
            "{} has no render settings with a resolution: give `size`, of the picture", usd.file));
    UsdViews views{.source = request.camera.file,
                   .stage = stage_of(request.camera),
                   .camera = camera.path,
                   .up_axis = usd.up_axis,
                   .frames_per_second = usd.frames_per_second,
                   .windows = windows_of_size(size->x, size->y),
                   .lens_points = {},
                   .frames = {}};
    views.windows.pixel_aspect = float(usd.pixel_aspect);
    std::vector<double> times;
    for (const auto &[time, values] : camera.frames) times.push_back(time);
    if (frame || times.empty()) times = {frame.value_or(0)}; // a camera without frames cannot be used
    views.keyed = frame || times.size() > 1;
    for (const double time : times) {
        const FilmCamera film = film_camera(usd, camera, time);
        if (time == times[0]) notify_warnings(notify, stated_warnings(film, request.lens));
        const Camera at = camera_with_options(request.lens, with_film(film, {}, views.windows));
        const ThinLens lens = resolve_lens(at, views.windows);
        views.metres_per_unit = at.metres_per_unit.value_or(1);
        UsdLensFrame &made = views.frames[time] =
            usd_lens_frame(at, lens, views.windows.display_width(), usd.file);
        made.clipping = clipping_range(usd, camera, time);
    }
    if (request.views > 0) add_lens_points(views, rim_lens_points(request.views));
    return views;
}

void add_planned(UsdViews &views, const PlannedViews &planned, std::optional<int> frame) {
    const auto &[plan, setting, camera] = planned;
    const double unit = camera.metres_per_unit.value_or(1);
    const bool first = views.frames.empty();
    if (!first && (views.windows != setting.windows || views.metres_per_unit != unit))
        throw Error(setting.centre + ": its size or scene unit is not that of the frames before");
    views.frames[frame.value_or(0)] =
        usd_lens_frame(camera, setting.lens, setting.windows.display_width(), setting.centre);
    std::vector<Imath::V2d> points;
    for (const PlannedView &view : plan.views) points.push_back(view.u);
    add_lens_points(views, points);
    if (!first) return;
    views.source = setting.centre;
    views.windows = setting.windows;
    views.metres_per_unit = unit;
    views.keyed = frame.has_value();
}

} // namespace sparselens
