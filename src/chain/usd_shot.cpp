#include "chain/usd_shot.h"

#include "base/error.h"
#include "chain/notices.h"
#include "lens/lens_points.h"

#include <fmt/format.h>

#include <vector>

namespace sparselens {

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
