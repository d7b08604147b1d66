// Projection matrices as renderers write them, converted to one convention.
//
// A point of the world times worldToNDC, divided by its w, is a position in the picture. In the standard of OpenEXR,
// (0,0) is the upper left and (1,1) the lower right corner of the display window. Other writers use clip space, where
// the lower left corner is (-1,-1) and the upper right one (1,1), or let y point up. Matrices act on row vectors, but
// may be stored transposed.
#pragma once

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <optional>

namespace sparselens {

struct Projection {
    double field;             // width of the picture over the focal length, (0, inf)
    Imath::M44d world_to_ndc; // in the standard of OpenEXR
    bool looks_backward;      // world_to_camera puts the scene at negative z, so z must change sign
};

// The view frustum by a worldToNDC in the standard of OpenEXR.
struct Frustum {
    double field;               // width of the picture over the focal length, (0, inf)
    Imath::V2d principal_point; // see Camera::principal_point
};

// Empty if the matrix is not a perspective projection from the position of that camera.
std::optional<Frustum> frustum_of(const Imath::M44d &world_to_ndc, const Imath::M44d &world_to_camera);

// Whether w is the same for all points, with row vectors. The unit matrix is not counted.
bool is_orthographic(const Imath::M44d &world_to_ndc);

struct ProjectionHints {
    bool clip_space = false;     // known to be clip space; if false it may be either
    std::optional<double> field; // from other attributes; it tells the conventions apart
};

// Empty if `world_to_ndc` is not a perspective projection from the position of that camera, mirrors the picture, or is
// so far off-axis that without a hint both conventions are equally likely.
std::optional<Projection> read_projection(const Imath::M44d &world_to_ndc, const Imath::M44d &world_to_camera,
                                          const ProjectionHints &hints);

} // namespace sparselens
