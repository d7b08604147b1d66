// Puts views where their cameras stood on the lens.
#pragma once

#include "view.h"

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct LensViews {
    std::vector<Imath::V2d> positions; // relative to the lens centre, scene units, x right, y up
    std::vector<Framing> framings;     // against the camera at the lens centre
    Camera centre;                     // the camera at the lens centre
    bool centre_guessed = false;       // whether it is only the mean of the views' positions
};

// Computes the positions from the worldToCamera of the views. The lens centre is the position of `centre`, if given;
// otherwise what the views state, if each names its own lens point; otherwise the mean of their positions. Throws
// UsageError if a view has no worldToCamera, and Error if the axes are not parallel or a view lies farther in front of
// or behind the lens centre than any view lies beside it. Messages name the view by `names`.
LensViews position_on_lens(std::span<const Camera> views, std::span<const std::string> names,
                           const std::optional<Camera> &centre);

// Checks views whose pictures are shifted as a whole. Throws Error, naming the view, if its focal length differs from
// the centre's, or if its camera lies in front of or behind the centre by more than a hundredth of the largest distance
// of a view along x or y.
void require_one_plane(const LensViews &views, std::span<const std::string> names);

// `camera` moved across the lens (x right, y up, scene units), with its matrices.
Camera moved_across_lens(Camera camera, const Imath::V2d &by);

// A view, as its file and the user describe it.
struct StatedView {
    std::string name;                        // for messages
    Camera camera;                           // as its file gives it
    std::optional<Imath::V2d> position = {}; // the position given by the user: scene units, x right, y up
};

// Where a view stands on the lens, and how it frames the scene.
struct ViewPlace {
    Imath::V2d position{0, 0}; // as in View
    Framing framing = {};
};

// Throws Error, naming both files, if their pixels are different fractions of a pixel of the picture
// (Camera::supersample).
void require_same_subpixels(const Camera &first, const std::string &first_name, const Camera &other,
                            const std::string &name);

// Throws Error, naming both files, if their cameras are known to have different fields of view. `widths`: of their
// display windows, in pixels.
void require_same_field(const Camera &first, const std::string &first_name, const Camera &other,
                        const std::string &name, std::array<int, 2> widths);

struct PlacedCameras {
    Camera centre; // with the lens points of all views
    std::vector<ViewPlace> places;
};

// The first view is the centre. A position is the stated one; if there is none, it follows from worldToCamera. Throws
// the errors of position_on_lens and require_same_subpixels().
PlacedCameras place_cameras(std::span<const StatedView> stated);

// Sets position, framing and depth of views[1] and all later views, relative to the centre views[0], by
// place_cameras(). Returns the camera of the centre, with the lens points of all views.
Camera place_views(std::span<View> views, std::span<const StatedView> stated);

// Projection matrices as renderers write them, converted to one convention.
//
// A point of the world times worldToNDC, divided by its w, is a position in the picture. In the standard of OpenEXR,
// (0,0) is the upper left and (1,1) the lower right corner of the display window. Other writers use clip space, where
// the lower left corner is (-1,-1) and the upper right one (1,1), or let y point up. Matrices act on row vectors, but
// may be stored transposed.
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

// Whether the matrix is that of an orthographic camera: w is the same for all points. The unit matrix does not count.
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
