#include "common/view_list.h"

#include "base/error.h"
#include "common/picture_options.h"

#include <cmath>
#include <sstream>

namespace sparselens {

namespace {

Imath::V2d placed_position(const std::string &text) {
    const auto position = parse_pair(text);
    if (!position) throw UsageError("--view: '" + text + "' is not X,Y");
    return *position;
}

Imath::V2d metadata_position(const Camera &centre, const Camera &view, const std::string &path) {
    const auto position = position_relative_to(centre, view, path);
    if (!position)
        throw UsageError(path +
                         ": where its camera stood is unknown (no worldToCamera here or in the centre "
                         "view): give --view X,Y " +
                         path);
    if (std::abs(position->z) > 1e-3 * std::hypot(position->x, position->y) + 1e-6)
        throw Error(path + ": its camera stands in front of or behind the centre view's, not beside it");
    return {position->x, position->y};
}

} // namespace

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
    LoadedViews loaded;
    Camera centre;
    for (const std::string &path : list.files) {
        LoadedView next = load_view(path, lens, depth);
        if (loaded.views.empty()) {
            centre = next.camera;
            loaded.header = std::move(next.header);
            loaded.camera = camera_with_options(lens, centre);
        } else {
            next.view.position = metadata_position(centre, next.camera, path);
        }
        loaded.views.push_back(std::move(next.view));
    }
    for (const auto &[position, path] : list.placed) {
        LoadedView next = load_view(path, lens, depth);
        next.view.position = placed_position(position);
        loaded.views.push_back(std::move(next.view));
    }
    return loaded;
}

} // namespace sparselens
