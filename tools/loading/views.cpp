#include "loading/views.h"

#include "options/picture_options.h"
#include "view/lens_views.h"

#include <span>

namespace sparselens {

namespace {

void put(View &view, const Imath::V2d &position, const Framing &framing) {
    view.position = position;
    view.framing = framing;
    if (framing.forward == 0) return;
    for (float &z : view.z) z = float(double(z) + framing.forward);
}

void add(OpenedViews &to, OpenedView &opened) {
    to.views.push_back(std::move(opened.view));
    to.bad.push_back(opened.bad);
    to.notes.push_back(std::move(opened.notes));
    to.warnings.push_back(std::move(opened.warnings));
}

} // namespace

OpenedViews open_views(const ViewList &list, const OpenOptions &options) {
    std::vector<Imath::V2d> offsets; // read first: a mistake is said before the work
    for (const auto &[offset, path] : list.placed) offsets.push_back(view_offset(offset));
    OpenedViews opened;
    OpenedView first = open_view(list.files[0], options);
    const Camera centre = first.camera;
    opened.header = std::move(first.header);
    add(opened, first);
    const std::span rim_files = std::span(list.files).subspan(1);
    std::vector<Camera> rim_cameras;
    for (const std::string &path : rim_files) {
        OpenedView next = open_view(path, options, centre);
        rim_cameras.push_back(std::move(next.camera));
        add(opened, next);
    }
    const LensViews placed = position_on_lens(rim_cameras, rim_files, centre);
    for (std::size_t i = 0; i < placed.positions.size(); ++i)
        put(opened.views[i + 1], placed.positions[i], placed.framings[i]);
    opened.views[0].framing.principal_point = centre.principal_point.value_or(Imath::V2d(0, 0));
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        OpenedView next = open_view(list.placed[i].second, options, centre);
        put(next.view, offsets[i], framing_relative_to(centre, next.camera, next.view.name));
        add(opened, next);
    }
    opened.camera = centre;
    opened.camera.lens_points.clear();
    for (const View &view : opened.views) opened.camera.lens_points.push_back(view.position);
    return opened;
}

} // namespace sparselens
