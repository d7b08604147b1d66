#include "view/place_views.h"

namespace sparselens {

namespace {

void put(View &view, const Imath::V2d &position, const Framing &framing) {
    view.position = position;
    view.framing = framing;
    if (framing.forward == 0) return;
    for (float &z : view.z) z = float(double(z) + framing.forward);
}

} // namespace

Camera place_views(std::span<View> views, std::span<const StatedView> stated) {
    Camera centre = stated[0].camera;
    std::vector<std::size_t> unplaced; // views that only their cameras place
    std::vector<Camera> cameras;
    std::vector<std::string> names;
    for (std::size_t i = 1; i < views.size(); ++i) {
        if (stated[i].position) {
            put(views[i], *stated[i].position, framing_relative_to(centre, stated[i].camera, stated[i].name));
            continue;
        }
        unplaced.push_back(i);
        cameras.push_back(stated[i].camera);
        names.push_back(stated[i].name);
    }
    const LensViews placed = position_on_lens(cameras, names, centre);
    for (std::size_t i = 0; i < unplaced.size(); ++i)
        put(views[unplaced[i]], placed.positions[i], placed.framings[i]);
    views[0].framing.principal_point = centre.principal_point.value_or(Imath::V2d(0, 0));
    centre.lens_points.clear();
    for (const View &view : views) centre.lens_points.push_back(view.position);
    return centre;
}

} // namespace sparselens
