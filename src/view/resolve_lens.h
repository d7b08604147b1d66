// From what a file and its user say of a camera to a lens. What neither says is a UsageError that names the option
// which settles it.
#pragma once

#include "../base/image.h"
#include "../lens/thin_lens.h"
#include "camera.h"

#include <optional>

namespace sparselens {

// What a user says of the lens. Every value may be left to the file.
struct LensValues {
    std::optional<double> focal_length_mm = {}; // (0, inf)
    std::optional<double> sensor_width_mm = {}; // (0, inf), spans the display window
    std::optional<double> fstop = {};           // (0, inf]; at most one of this and the radius
    std::optional<double> lens_radius = {};     // of the aperture, scene units, [0, inf)
    std::optional<double> focus_distance = {};  // scene units, (0, inf]
    std::optional<double> scene_unit = {};      // its length in metres, (0, inf)
};

// The file's camera with the user's values over it. A radius becomes the f-number, too, where the focal length is
// known; another scene unit leaves the file's focus where it is in metres.
Camera camera_with_options(const LensValues &values, Camera from_file);

// Radius of the aperture, scene units: as it was given, else by the f-number; empty where neither is known, or the
// focal length is missing.
std::optional<double> lens_radius_of(const Camera &camera);

// The same, or UsageError.
double resolve_radius(const Camera &camera);

// Focal length in pixels, or UsageError. `windows` gives the display width.
double resolve_focal_px(const Camera &camera, const Windows &windows);

// The lens, or UsageError. A lens of radius 0 (radius 0, f-number inf) needs no other value. `windows` gives the
// display width and the pixel aspect.
ThinLens resolve_lens(const Camera &camera, const Windows &windows);

} // namespace sparselens
