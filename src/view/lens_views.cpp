#include "view/lens_views.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

bool all_know_their_lens_point(std::span<const Camera> views) {
    return std::all_of(views.begin(), views.end(),
                       [](const Camera &view) { return view.lens_points.size() == 1; });
}

Imath::V2d mean(std::span<const Imath::V2d> points) {
    Imath::V2d sum(0, 0);
    for (const Imath::V2d &p : points) sum += p;
    return sum / double(points.size());
}

// Matrices are stored as float: a camera far from the world's origin is placed no better than this.
double rounding(const Camera &camera) {
    const Imath::M44d &m = *camera.world_to_camera;
    return 1e-6 * std::max({std::abs(m[3][0]), std::abs(m[3][1]), std::abs(m[3][2])});
}

std::string why_not_placed(const Camera &origin, const Camera &view) {
    const Camera &culprit = view.world_to_camera ? origin : view;
    const auto reason = culprit.unsure.find("--view");
    const std::string text = reason == culprit.unsure.end() ? "no worldToCamera" : reason->second;
    return view.world_to_camera ? "that of the centre: " + text : text;
}

std::vector<Imath::V2d> positions_from(const Camera &origin, std::span<const Camera> views,
                                       std::span<const std::string> names) {
    std::vector<Imath::V3d> positions;
    double spread = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const auto position = position_relative_to(origin, views[i], names[i]);
        if (!position)
            throw UsageError(names[i] + ": its camera is unknown (" + why_not_placed(origin, views[i]) +
                             "): give --view X,Y " + names[i]);
        positions.push_back(*position);
        spread = std::max({spread, std::abs(position->x), std::abs(position->y)});
    }
    std::vector<Imath::V2d> across;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const Imath::V3d &p = positions[i];
        if (std::abs(p.z) > 0.01 * spread + rounding(views[i]))
            throw Error(names[i] + ": stands in front of or behind the other views; a lens is flat");
        across.emplace_back(p.x, p.y);
    }
    return across;
}

} // namespace

LensViews place_on_lens(std::span<const Camera> views, std::span<const std::string> names,
                        const std::optional<Camera> &centre) {
    if (centre) return {positions_from(*centre, views, names), *centre};
    LensViews result{positions_from(views.front(), views, names), views.front()};
    result.centre_guessed = !all_know_their_lens_point(views);
    const Imath::V2d middle =
        result.centre_guessed ? mean(result.positions) : -views.front().lens_points.front();
    for (Imath::V2d &p : result.positions) p -= middle;
    result.centre = moved_across_lens(views.front(), middle);
    return result;
}

Camera moved_across_lens(Camera camera, const Imath::V2d &by) {
    if (!camera.world_to_camera) return camera;
    Imath::M44d move;
    move.setTranslation(Imath::V3d(-by.x, -by.y, 0));
    const Imath::M44d moved = *camera.world_to_camera * move;
    if (camera.world_to_ndc)
        *camera.world_to_ndc = moved * camera.world_to_camera->inverse() * *camera.world_to_ndc;
    camera.world_to_camera = moved;
    return camera;
}

} // namespace sparselens
