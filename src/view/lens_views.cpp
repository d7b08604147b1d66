#include "view/lens_views.h"

#include "base/error.h"

#include <fmt/format.h>

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

// The uncertainty of a position. Matrices are stored as float, so a camera far from the world's origin is placed no
// better.
double rounding(const Camera &camera) {
    const Imath::M44d &m = *camera.world_to_camera;
    return 1e-6 * std::max({std::abs(m[3][0]), std::abs(m[3][1]), std::abs(m[3][2])});
}

std::string why_not_placed(const Camera &origin, const Camera &view) {
    const Camera &culprit = view.world_to_camera ? origin : view;
    const auto reason = culprit.unsure.find("view");
    const std::string text = reason == culprit.unsure.end() ? "no worldToCamera" : reason->second;
    return view.world_to_camera ? "that of the centre: " + text : text;
}

double spread_of(std::span<const Imath::V2d> positions) {
    double spread = 0;
    for (const Imath::V2d &p : positions) spread = std::max({spread, std::abs(p.x), std::abs(p.y)});
    return spread;
}

// `origin`, and the views relative to it.
LensViews seen_from(const Camera &origin, std::span<const Camera> views, std::span<const std::string> names) {
    LensViews placed{{}, {}, origin};
    for (std::size_t i = 0; i < views.size(); ++i) {
        const auto position = position_relative_to(origin, views[i], names[i]);
        if (!position)
            throw UsageError(fmt::format("{0}: its camera is unknown ({1}): give `view=X,Y {0}`", names[i],
                                         why_not_placed(origin, views[i])));
        placed.positions.emplace_back(position->x, position->y);
        placed.framings.push_back(framing_relative_to(origin, views[i], names[i]));
        placed.framings.back().forward = position->z;
    }
    const double spread = spread_of(placed.positions);
    for (std::size_t i = 0; i < views.size(); ++i) {
        double &forward = placed.framings[i].forward;
        if (std::abs(forward) > spread + rounding(views[i]))
            throw Error(names[i] +
                        ": stands in front of or behind the other views, but a lens is flat: leave it out");
        if (std::abs(forward) <= 1e-4 * spread + rounding(views[i])) forward = 0;
    }
    return placed;
}

// `camera` with its picture moved to the right and down, in picture widths.
Camera with_picture_moved(Camera camera, const Imath::V2d &by) {
    if (by == Imath::V2d(0, 0)) return camera;
    camera.principal_point = camera.principal_point.value_or(Imath::V2d(0, 0)) + by;
    if (!camera.world_to_ndc) return camera;
    const Imath::M44d to_ndc = camera.world_to_camera->inverse() * *camera.world_to_ndc;
    Imath::M44d move;
    move.setTranslation(Imath::V3d(by.x, by.y * std::abs(to_ndc[1][1] / to_ndc[0][0]), 0));
    *camera.world_to_ndc *= move;
    return camera;
}

} // namespace

LensViews position_on_lens(std::span<const Camera> views, std::span<const std::string> names,
                           const std::optional<Camera> &centre) {
    if (centre) return seen_from(*centre, views, names);
    LensViews result = seen_from(views.front(), views, names);
    result.centre_guessed = !all_know_their_lens_point(views);
    const Imath::V2d middle =
        result.centre_guessed ? mean(result.positions) : -views.front().lens_points.front();
    for (Imath::V2d &p : result.positions) p -= middle;
    // Frusta that converge are shifted in proportion to the positions, so their mean belongs to the middle.
    std::vector<Imath::V2d> shifts;
    const Imath::V2d first = result.framings.front().principal_point;
    for (const Framing &framing : result.framings) shifts.push_back(framing.principal_point - first);
    result.centre = with_picture_moved(moved_across_lens(views.front(), middle),
                                       result.centre_guessed ? mean(shifts) : Imath::V2d(0, 0));
    return result;
}

void require_one_plane(const LensViews &views, std::span<const std::string> names) {
    const double spread = spread_of(views.positions);
    for (std::size_t i = 0; i < views.framings.size(); ++i) {
        if (std::abs(views.framings[i].forward) > 0.01 * spread)
            throw Error(names[i] +
                        ": stands in front of or behind the other views, but a lens is flat: leave it out");
        if (std::abs(views.framings[i].zoom - 1) > 1e-4)
            throw Error(names[i] + ": its focal length differs from that of the other views");
    }
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
