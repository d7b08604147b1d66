#include "view/projection.h"

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>

namespace sparselens {

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
