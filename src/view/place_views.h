// Puts views where their cameras stood on the lens.
#pragma once

#include "lens_views.h"
#include "view.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct StatedView {
    std::string name;                        // for messages
    Camera camera;                           // as its file gives it
    std::optional<Imath::V2d> position = {}; // the position given by the user: scene units, x right, y up
};

// The position of a view.
struct ViewPlace {
    Imath::V2d position{0, 0}; // as in View
    Framing framing = {};
};

// Throws Error, naming both files, if their pixels are different fractions of a pixel of the picture
// (Camera::supersample).
void require_same_subpixels(const Camera &first, const std::string &first_name, const Camera &other,
                            const std::string &name);

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

} // namespace sparselens
