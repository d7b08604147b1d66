#include "view/lens_views.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

// The uncertainty of a position, scene units. Matrices are stored as float, so it grows with the distance from the
// world's origin.
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

void require_same_subpixels(const Camera &first, const std::string &first_name, const Camera &other,
                            const std::string &name) {
    const int expected = first.supersample.value_or(1), found = other.supersample.value_or(1);
    if (found == expected) return;
    throw Error(fmt::format("{}: {} x {} of its pixels are one of the picture, and {} x {} of {} "
                            "(ldi.supersample): use files that agree, or say it for all by `supersample`",
                            name, found, found, expected, expected, first_name));
}

void require_same_field(const Camera &first, const std::string &first_name, const Camera &other,
                        const std::string &name, std::array<int, 2> widths) {
    const auto focal = focal_length_px(first, widths[0]), others = focal_length_px(other, widths[1]);
    constexpr double rounding = 1e-3; // relative, for values that other programs have written
    if (!focal || !others) return;
    const double as_first = *others * widths[0] / widths[1];
    if (std::abs(as_first / *focal - 1) > rounding)
        throw Error(
            fmt::format("{}: its focal length is {:g} pixels, that of {} is {:g}; use pictures of one "
                        "camera, or give `focal_length` and `sensor_width`",
                        name, as_first, first_name, *focal));
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

namespace {

// Where the camera's axes appear, in the units of the file's NDC.
struct Seen {
    Imath::V2d centre; // straight ahead
    Imath::V2d scale;  // the motion for a step to the right and up at depth 1
    bool backward;     // the scene lies at negative z
};

// Matrices are stored as float.
double rounding_of(const Imath::M44d &to_world) { return 1e-6 * to_world.translation().length(); }

std::optional<Seen> seen_by(const Imath::M44d &camera_to_ndc, double rounding) {
    const Imath::M44d &m = camera_to_ndc;
    const double w = std::abs(m[2][3]);
    const bool depth_alone = std::abs(m[0][3]) <= 1e-3 * w && std::abs(m[1][3]) <= 1e-3 * w &&
                             std::abs(m[3][3]) <= (1e-3 + rounding) * w;
    if (!(w > 0) || !depth_alone) return {};
    const Seen seen{Imath::V2d(m[2][0], m[2][1]) / m[2][3], Imath::V2d(m[0][0], m[1][1]) / w, m[2][3] < 0};
    const bool sound = std::isfinite(seen.centre.x) && std::isfinite(seen.centre.y) && seen.scale.x > 0 &&
                       std::isfinite(seen.scale.x) && std::isfinite(seen.scale.y) && seen.scale.y != 0;
    return sound ? std::optional(seen) : std::nullopt;
}

// 1 if NDC goes from 0 to 1 across the picture, 2 if from -1 to 1, 0 if undecided.
int span_of(const Seen &seen, const ProjectionHints &hints) {
    if (hints.clip_space) return 2;
    for (const int span : {1, 2})
        if (hints.field && std::abs(span / seen.scale.x / *hints.field - 1) < 0.01) return span;
    const auto near = [&](double middle) {
        return std::max(std::abs(seen.centre.x - middle), std::abs(seen.centre.y - middle)) < 0.25;
    };
    return near(0.5) ? 1 : near(0) ? 2 : 0;
}

// The matrix from NDC of that span and direction of y to [0,1], y down.
Imath::M44d to_standard(int span, bool y_up) {
    Imath::M44d m;
    m[0][0] = 1.0 / span;
    m[1][1] = (y_up ? -1.0 : 1.0) / span;
    m[3][0] = span == 2 ? 0.5 : 0;
    m[3][1] = span == 2 ? 0.5 : y_up ? 1 : 0;
    return m;
}

} // namespace

std::optional<Frustum> frustum_of(const Imath::M44d &world_to_ndc, const Imath::M44d &world_to_camera) {
    const Imath::M44d to_world = world_to_camera.inverse();
    const auto seen = seen_by(to_world * world_to_ndc, rounding_of(to_world));
    if (!seen) return {};
    const Imath::V2d off = seen->centre - Imath::V2d(0.5);
    return Frustum{1 / seen->scale.x, {off.x, off.y * seen->scale.x / std::abs(seen->scale.y)}};
}

bool is_orthographic(const Imath::M44d &m) {
    return m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] != 0 && m != Imath::M44d();
}

std::optional<Projection> read_projection(const Imath::M44d &world_to_ndc, const Imath::M44d &world_to_camera,
                                          const ProjectionHints &hints) {
    const Imath::M44d to_world = world_to_camera.inverse();
    const double rounding = rounding_of(to_world);
    for (const Imath::M44d &matrix : {world_to_ndc, world_to_ndc.transposed()}) {
        const auto seen = seen_by(to_world * matrix, rounding);
        const int span = seen ? span_of(*seen, hints) : 0;
        if (span > 0)
            return Projection{span / seen->scale.x, matrix * to_standard(span, seen->scale.y > 0),
                              seen->backward};
    }
    return {};
}

} // namespace sparselens
