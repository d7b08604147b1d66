// Makes a lens from the camera values of a file and of its user. If a value is in neither, UsageError names the
// parameter to give.
#pragma once

#include "../base/image.h"
#include "../lens/lens_looks.h"
#include "../lens/thin_lens.h"
#include "../looks/look.h"
#include "../looks/table.h"
#include "view.h"

#include <optional>
#include <span>

namespace sparselens {

// Lens values of the user. An empty value is taken from the file.
struct LensValues {
    std::optional<double> focal_length_mm = {}; // (0, inf)
    std::optional<double> sensor_width_mm = {}; // (0, inf), spans the display window
    std::optional<double> fstop = {};           // (0, inf]; at most one of this and the radius
    std::optional<double> lens_radius = {};     // of the aperture, scene units, [0, inf)
    std::optional<double> focus_distance = {};  // scene units, (0, inf]
    std::optional<double> scene_unit = {};      // its length in metres, (0, inf)
};

std::span<const NumberParameter<LensValues>> lens_numbers();

// The camera of the file, with the values of the user in place of its own. If a radius is given and the focal length is
// known, the f-number is computed. Another scene unit does not change the focus distance of the file in metres.
Camera camera_with_options(const LensValues &values, Camera from_file);

// The radius of the aperture in scene units: as given, otherwise from the f-number. Empty if neither is known, or if
// the focal length, which the f-number needs, is unknown.
std::optional<double> lens_radius_of(const Camera &camera);

// The same, but throws UsageError instead of returning nothing.
double resolve_radius(const Camera &camera);

// The focal length in pixels; throws UsageError if it is unknown. `windows` gives the display width.
double resolve_focal_px(const Camera &camera, const Windows &windows);

// R F, the scale of disparity, in pixels times scene units; 0 for a lens of radius 0. If a value that it needs
// is unknown, it throws UsageError if `required`, and otherwise returns nothing.
std::optional<double> disparity_scale(const Camera &camera, const Windows &windows, bool required);

// The lens; throws UsageError, which names all missing values. A lens of radius 0 (or f-number inf) needs no other
// value. `windows` gives the display width and the pixel aspect.
ThinLens resolve_lens(const Camera &camera, const Windows &windows);

// The same, but empty if a value is missing.
std::optional<ThinLens> known_lens(const Camera &camera, const Windows &windows);

// The largest distance of an LDI's views from the centre of the lens, in scene units; 0 if its camera does not give
// their positions.
double views_radius(const Camera &camera);

// Whether the lens sees past the views from which its LDI was made; false if the camera does not give their positions.
bool sees_past_views(const Camera &camera, const ThinLens &lens);

// Turns the looks that a user, a lens file and a picture's header give into those of one lens and picture.

// `lens` is the picture's lens (a proxy's has a shorter focal length in pixels). Throws UsageError if a look needs the
// focal length and it is unknown, or if the lens cannot focus that near.
LensLooks resolve_looks(const LookValues &values, const Camera &camera, const ThinLens &lens,
                        const Windows &windows);

} // namespace sparselens
