// A camera as USD describes it: a film of a certain shape, which a picture of another shape does not fit.
#pragma once

#include "../../base/image.h"
#include "../../view/view.h"

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <optional>
#include <string>

namespace sparselens {

// How the film is made to fit the picture (UsdRenderSettings, aspectRatioConformPolicy).
enum class FilmFit {
    expand,    // the larger of both frames: USD's default
    crop,      // the smaller
    by_height, // keep the height, adjust the width
    by_width,  // keep the width
};

struct FilmCamera {
    std::string name; // "shot.usda</World/camera>", for messages
    double focal_length_mm = 50, film_width_mm = 36, film_height_mm = 24; // (0, inf)
    Imath::V2d offset_mm{0, 0}; // of the film's middle from the optical axis, x right, y up, as projected
    FilmFit fit = FilmFit::expand;
    double metres_per_unit = 0.01;
    std::optional<double> fstop = {}, focus_distance = {}; // as in Camera
    Imath::M44d world_to_camera = {};                      // as in Camera
    bool places = true;       // false: world_to_camera is not used, only the frustum and the lens
    std::string warning = {}; // what its file lacks; or empty
};

// The camera of the file with the values of `film` instead of its own. `windows` are the picture's.
Camera with_film(const FilmCamera &film, Camera of_file, const Windows &windows);

} // namespace sparselens
