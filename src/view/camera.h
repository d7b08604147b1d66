// What a file or a command line says about the camera that took a picture. Every value may be unknown.
#pragma once

#include "framing.h"

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sparselens {

// Camera space: +x right, +y up, +z forward. Matrices act on row vectors, as in OpenEXR.
struct Camera {
    std::optional<double> focal_length_mm; // (0, inf)
    std::optional<double> sensor_width_mm; // (0, inf), spans the display window
    std::optional<double> fstop;           // (0, inf]
    std::optional<double> lens_radius;     // of the aperture, scene units, [0, inf): as a user gave it
    std::optional<double> focus_distance;  // scene units, (0, inf]
    std::optional<double> metres_per_unit; // (0, inf)
    // Width of the picture over the focal length, (0, inf): known from a field of view or a projection matrix where
    // one of the two is not.
    std::optional<double> field;
    // Where the optical axis meets the picture: from the middle of the display window, in its widths, x right, y down,
    // pixels taken as square. Unknown, it is the middle.
    std::optional<Imath::V2d> principal_point;
    std::optional<Imath::M44d> world_to_camera;
    std::optional<Imath::M44d> world_to_ndc; // NDC: (0,0) and (1,1) are the display window's corners, y down
    std::vector<Imath::V2d> lens_points;     // of an LDI: where its views stood, scene units, x right, y up

    std::vector<std::string> found; // what was read, from which attribute: for people
    // Why a value is unknown although the file has something of it (it is none, or two attributes contradict each
    // other), by the option that settles it: "--focal-length".
    std::map<std::string, std::string> unsure;
};

// Puts in of focal length, film back and field the one that follows from the others, unless
// the file has something else of it (Camera::unsure).
void complete_field(Camera &camera);

// Focal length in pixels of a picture `display_width` pixels wide; empty where neither focal length and film back
// nor the field is known.
std::optional<double> focal_length_px(const Camera &camera, int display_width);

// How `view` frames the picture otherwise than `centre`; `forward` is left to position_relative_to(). What is not
// known of the view is as in the centre; differences that the rounding of matrices to float makes are none. Throws
// Error (naming `what`) where its focal length is less than half or more than twice the centre's: they are no views
// of one lens.
Framing framing_relative_to(const Camera &centre, const Camera &view, const std::string &what);

// Position of `view` in the camera space of `centre`, scene units. Empty where either matrix is unknown.
// Throws Error (naming `what`) where the axes are not parallel.
std::optional<Imath::V3d> position_relative_to(const Camera &centre, const Camera &view,
                                               const std::string &what);

} // namespace sparselens
