#include "lab/tests/support/traced.h"

#include "lab/trace/scenes.h"
#include "lens/lens_points.h"

#include <algorithm>

namespace sparselens::lab {

SceneCamera::SceneCamera(std::string_view name, int width, int height) : tracer(build_scene(name)) {
    const Camera &camera = tracer.scene().camera;
    settings.windows = windows_of_size(width, height);
    settings.lens.radius = *camera.focal_length_mm / 1000 / (2 * *camera.fstop) / *camera.metres_per_unit;
    settings.lens.focal_px = *focal_length_px(camera, width);
    settings.lens.focus = *camera.focus_distance;
    settings.camera = tracer.scene().camera_motion;
}

SceneCamera::SceneCamera(const Scene &scene, const ThinLens &lens, int width, int height)
    : tracer(scene), settings{.windows = windows_of_size(width, height), .lens = lens} {}

View SceneCamera::view(const Imath::V2d &u, int samples, std::uint32_t stream) const {
    Progress silent;
    const Image picture = render_view(tracer, settings, u, samples, stream, silent);
    View view{"view", Image(picture.windows, rgba_channels()), {}, settings.lens.radius * u};
    for (std::size_t k = 0; k < 4; ++k)
        std::ranges::copy(picture.plane(find_channel(picture.channels, view.image.channels[k].name)),
                          view.image.plane(k).begin());
    const auto z = picture.plane(find_channel(picture.channels, "Z"));
    view.z.assign(z.begin(), z.end());
    return view;
}

std::vector<View> SceneCamera::five_views(int samples) const {
    std::vector<View> views{view({0, 0}, samples, 0)};
    for (const Imath::V2d &u : rim_lens_points(4))
        views.push_back(view(u, samples, std::uint32_t(views.size())));
    return views;
}

Image SceneCamera::reference(int samples) const {
    Progress silent;
    return render_reference(tracer, settings, samples, silent);
}

} // namespace sparselens::lab
