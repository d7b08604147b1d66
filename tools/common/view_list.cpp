#include "common/view_list.h"

#include "common/picture_options.h"
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

LoadedViews load_views(const ViewList &list, const LensOptions &lens, const DepthOptions &depth) {
    std::vector<Imath::V2d> offsets; // read first: a mistake is said before the work
    for (const auto &[offset, path] : list.placed) offsets.push_back(view_offset(offset));
    LoadedViews loaded;
    std::vector<Camera> cameras; // of the files
    for (const std::string &path : list.files) {
        LoadedView next = load_view(path, lens, depth);
        if (cameras.empty()) loaded.header = std::move(next.header);
        cameras.push_back(std::move(next.camera));
        loaded.views.push_back(std::move(next.view));
        loaded.bad.push_back(next.bad);
    }
    const std::span rim_cameras = std::span(cameras).subspan(1);
    const std::span rim_files = std::span(list.files).subspan(1);
    const LensViews placed = place_on_lens(rim_cameras, rim_files, cameras[0]);
    for (std::size_t i = 0; i < placed.positions.size(); ++i)
        loaded.views[i + 1].position = placed.positions[i];
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        LoadedView next = load_view(list.placed[i].second, lens, depth);
        next.view.position = offsets[i];
        loaded.views.push_back(std::move(next.view));
        loaded.bad.push_back(next.bad);
    }
    loaded.camera = camera_with_options(lens, cameras[0]);
    loaded.camera.lens_points.clear();
    for (const View &view : loaded.views) loaded.camera.lens_points.push_back(view.position);
    return loaded;
}

} // namespace sparselens
