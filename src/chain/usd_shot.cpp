#include "chain/usd_shot.h"

#include "base/error.h"
#include "chain/notices.h"
#include "io/usd/usd_transform.h"
#include "lens/lens_points.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <vector>

namespace sparselens {

namespace {

constexpr double most_frames = 100'000;

// The times of samples, and the whole frames between them.
std::set<double> times_of(const UsdPath &camera, const std::string &file) {
    std::set<double> times = sample_times(camera);
    if (times.size() < 2) return {times.empty() ? 0 : *times.begin()};
    const double first = *times.begin(), last = *times.rbegin();
    if (!(last - first <= most_frames))
        throw Error(fmt::format("{}: its camera is keyed from {:g} to {:g}, over too many frames", file,
                                first, last));
    for (double frame = std::ceil(first); frame <= last; ++frame) times.insert(frame);
    return times;
}

} // namespace

UsdViews views_of_shot(const ShotRequest &request, const Tell &tell) {
    const UsdCameras usd(request.camera.file);
    const UsdPath &camera = camera_called(usd, request.camera.name);
    const std::optional<Imath::V2i> size = request.size ? request.size : usd.resolution;
    if (!size)
        throw UsageError(fmt::format(
            "{} has no render settings with a resolution: give `size`, of the picture", usd.layer.file));
    UsdViews views{.source = request.camera.file,
                   .up_axis = usd.layer.up_axis,
                   .frames_per_second = usd.layer.frames_per_second,
                   .windows = windows_of_size(size->x, size->y),
                   .lens_points = {},
                   .frames = {}};
    views.windows.pixel_aspect = float(usd.pixel_aspect);
    const std::set<double> times =
        request.camera.frame ? std::set<double>{*request.camera.frame} : times_of(camera, usd.layer.file);
    views.keyed = request.camera.frame || times.size() > 1;
    for (const double time : times) {
        const FilmCamera film = film_camera(usd, camera, time);
        if (const auto warning = stated_warning(film, request.lens); warning && time == *times.begin())
            tell_warnings(tell, {*warning});
        const Camera at = camera_with_options(request.lens, with_film(film, {}, views.windows));
        const ThinLens lens = resolve_lens(at, views.windows);
        views.metres_per_unit = at.metres_per_unit.value_or(1);
        UsdLensFrame &frame = views.frames[time] =
            usd_lens_frame(at, lens, views.windows.display_width(), usd.layer.file);
        frame.clipping = clipping_range(usd, camera, time);
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
