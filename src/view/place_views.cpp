#include "view/place_views.h"

#include "base/error.h"

#include <fmt/format.h>

#include <utility>

namespace sparselens {

void require_same_subpixels(const Camera &first, const std::string &first_name, const Camera &other,
                            const std::string &name) {
    const int expected = first.supersample.value_or(1), found = other.supersample.value_or(1);
    if (found == expected) return;
    throw Error(fmt::format("{}: {} x {} of its pixels are one of the picture, and {} x {} of {} "
                            "(ldi.supersample): use files that agree, or say it for all by `supersample`",
                            name, found, found, expected, expected, first_name));
}

PlacedCameras place_cameras(std::span<const StatedView> stated) {
    Camera centre = stated[0].camera;
    for (const StatedView &view : stated)
        require_same_subpixels(centre, stated[0].name, view.camera, view.name);
    std::vector<ViewPlace> places(stated.size());
    std::vector<std::size_t> unplaced; // views that only their cameras place
    std::vector<Camera> cameras;
    std::vector<std::string> names;
    for (std::size_t i = 1; i < stated.size(); ++i) {
        if (stated[i].position) {
            places[i] = {*stated[i].position, framing_relative_to(centre, stated[i].camera, stated[i].name)};
            continue;
        }
        unplaced.push_back(i);
        cameras.push_back(stated[i].camera);
        names.push_back(stated[i].name);
    }
    const LensViews placed = position_on_lens(cameras, names, centre);
    for (std::size_t i = 0; i < unplaced.size(); ++i)
        places[unplaced[i]] = {placed.positions[i], placed.framings[i]};
    places[0].framing.principal_point = centre.principal_point.value_or(Imath::V2d(0, 0));
    centre.lens_points.clear();
    for (const ViewPlace &place : places) centre.lens_points.push_back(place.position);
    return {std::move(centre), std::move(places)};
}

Camera place_views(std::span<View> views, std::span<const StatedView> stated) {
    PlacedCameras placed = place_cameras(stated);
    for (std::size_t i = 0; i < views.size(); ++i) {
        const auto &[position, framing] = placed.places[i];
        views[i].position = position;
        views[i].framing = framing;
        if (framing.forward == 0) continue;
        for (float &z : views[i].z) z = float(double(z) + framing.forward);
    }
    return std::move(placed.centre);
}

} // namespace sparselens
