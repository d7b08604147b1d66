// Cameras of USD layers (UsdGeomCamera), and which view each of them takes.
//
// Apertures and focal lengths are in tenths of a scene unit: a film of 36 mm is 36 if a unit is a centimetre (USD's
// default), 360 if it is a millimetre, 0.36 if it is a metre. Cameras look along -z. An fStop or focusDistance of 0
// says that there is no depth of field, so the lens is unknown; sparselens:fStop and sparselens:focusDistance, which
// write_usd_views() adds, then give it.
#pragma once

#include "io/usd/film_camera.h"
#include "io/usd/usd_layer.h"

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

struct UsdCameras {
    UsdLayer layer;
    std::vector<UsdPath> cameras; // of `layer`; not empty
    FilmFit fit = FilmFit::expand;
    std::optional<Imath::V2i> resolution = {}; // of the render settings
    double pixel_aspect = 1;

    explicit UsdCameras(
        const std::string &path);            // throws as read_usd() does, and Error if there is no camera
    UsdCameras(const UsdCameras &) = delete; // the paths point into the layer
    UsdCameras &operator=(const UsdCameras &) = delete;
};

// The camera with that path, or with that last part of its path; if the name is empty, the only one, or the only one
// called "center". Throws UsageError that lists the cameras.
const UsdPath &camera_called(const UsdCameras &usd, const std::string &name);

// The camera whose name begins the name of the file: view_0 for views/view_0.0001.exr. Null if there is none.
const UsdPath *camera_of_file(const UsdCameras &usd, const std::string &file);

// Whether the values of the camera change with time.
bool is_animated(const UsdPath &camera);

// The camera at a time code. Throws Error, naming the file and the prim, for a camera that cannot be used:
// orthographic, mirrored, sheared, with an aperture of 0, or composed from other files.
FilmCamera film_camera(const UsdCameras &usd, const UsdPath &camera, double time);

// Near and far plane at a time code, scene units.
Imath::V2d clipping_range(const UsdCameras &usd, const UsdPath &camera, double time);

// A warning if the focal length is implausible, as in a file whose writer took lengths for millimetres.
std::optional<std::string> film_warning(const FilmCamera &film);

} // namespace sparselens
