// Projection matrices as renderers write them, brought to one convention.
//
// A point of the world times worldToNDC, divided by its w, is a place in the picture: in OpenEXR's standard (0,0) is
// the upper left and (1,1) the lower right corner of the display window; others write clip space, where the lower
// left corner is (-1,-1) and the upper right (1,1), or leave y upward. Matrices act on row vectors, but may be
// stored the other way round.
#pragma once

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <optional>

namespace sparselens {

struct Projection {
    double field;             // width of the picture over the focal length, (0, inf)
    Imath::M44d world_to_ndc; // as OpenEXR's standard has it
    bool looks_backward;      // world_to_camera has the scene at negative z: its z must change sign
};

// What a worldToNDC in OpenEXR's standard says of the picture.
struct Frustum {
    double field;               // width of the picture over the focal length, (0, inf)
    Imath::V2d principal_point; // see Camera::principal_point
};

// Empty where it is no perspective projection from the place of that camera.
std::optional<Frustum> frustum_of(const Imath::M44d &world_to_ndc, const Imath::M44d &world_to_camera);

struct ProjectionHints {
    bool clip_space = false;     // known to be clip space, else either
    std::optional<double> field; // as other attributes have it: tells the conventions apart
};

// Empty where `world_to_ndc` is no perspective projection from the place of that camera, or mirrors the picture, or
// is so far off-axis that without a hint both conventions are as likely.
std::optional<Projection> read_projection(const Imath::M44d &world_to_ndc, const Imath::M44d &world_to_camera,
                                          const ProjectionHints &hints);

} // namespace sparselens
