#include "loading/view_list.h"

#include "options/picture_options.h"
#include "view/lens_views.h"

#include <span>

namespace sparselens {

void add_view_list(CLI::App &app, ViewList &list) {
    app.add_option("views", list.files,
                   "Centre view, then views whose camera is in their metadata; - for standard input")
        ->type_name("CENTER.exr [VIEW.exr ...]")
        ->required();
    app.add_option("--view", list.placed,
                   "A view whose camera stood X right and Y up of the centre, scene units")
        ->type_name("X,Y VIEW.exr")
        ->allow_extra_args(false);
}

namespace {

void put(View &view, const Imath::V2d &position, const Framing &framing) {
    view.position = position;
    view.framing = framing;
    if (framing.forward == 0) return;
    for (float &z : view.z) z = float(double(z) + framing.forward);
}

} // namespace

LoadedViews load_views(const ViewList &list, const LensOptions &lens, const DepthOptions &depth) {
    std::vector<Imath::V2d> offsets; // read first: a mistake is said before the work
    for (const auto &[offset, path] : list.placed) offsets.push_back(view_offset(offset));
    LoadedViews loaded;
    std::vector<Camera> cameras; // of the files
    for (const std::string &path : list.files) {
        LoadedView next = load_view(path, lens, depth, cameras.empty() ? Camera() : cameras[0]);
        if (cameras.empty()) loaded.header = std::move(next.header);
        cameras.push_back(std::move(next.camera));
        loaded.views.push_back(std::move(next.view));
        loaded.bad.push_back(next.bad);
    }
    const std::span rim_files = std::span(list.files).subspan(1);
    std::vector<Camera> rim_cameras;
    for (const Camera &camera : std::span(cameras).subspan(1))
        rim_cameras.push_back(camera_with_options(lens, camera));
    const Camera centre = camera_with_options(lens, cameras[0]);
    const LensViews placed = position_on_lens(rim_cameras, rim_files, centre);
    for (std::size_t i = 0; i < placed.positions.size(); ++i)
        put(loaded.views[i + 1], placed.positions[i], placed.framings[i]);
    loaded.views[0].framing.principal_point = centre.principal_point.value_or(Imath::V2d(0, 0));
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        LoadedView next = load_view(list.placed[i].second, lens, depth, cameras[0]);
        put(next.view, offsets[i],
            framing_relative_to(centre, camera_with_options(lens, next.camera), next.view.name));
        loaded.views.push_back(std::move(next.view));
        loaded.bad.push_back(next.bad);
    }
    loaded.camera = centre;
    loaded.camera.lens_points.clear();
    for (const View &view : loaded.views) loaded.camera.lens_points.push_back(view.position);
    return loaded;
}

} // namespace sparselens
