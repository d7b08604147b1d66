// The cameras of a plan on disk, as JSON or, for a spreadsheet, as CSV.
//
//   {"version": 1, "center": FILE, "lens_radius": R, "focus_distance": D or null for infinity,
//    "metres_per_unit": M or null, "screen_window": {"width": W, "center": [X, Y]},
//    "horizontal_field_degrees": A,
//    "cameras": [{"name": "view_0", "offset": [X, Y], "world_to_camera": [[4 numbers], ...] or null,
//                 "camera_to_world": ... or null}, ...]}
//
// Offsets are in scene units, x right and y up. world_to_camera is for EXR headers: x right, y up, z forward.
// camera_to_world places a camera that looks along -z. Matrices act on row vectors: the last row is the translation.
// CSV has a line of names, then a line per camera; matrices are 16 columns, empty if they are unknown.
#pragma once

#include "plan/plan_cameras.h"

#include <string>

namespace sparselens {

// Data of the centre view that the file holds besides the cameras.
struct CamerasSetting {
    std::string centre;
    ThinLens lens;
    std::optional<double> metres_per_unit;
};

// Writes CSV if the name ends in .csv, JSON if it ends in .json. Throws UsageError for another name, and Error, naming
// the file, if it cannot be written.
void write_cameras(const std::string &path, const PlannedCameras &cameras, const CamerasSetting &setting);

} // namespace sparselens
