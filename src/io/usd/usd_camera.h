// Cameras of USD (UsdGeomCamera), and which view each of them takes. They come from a stage, through USD's own library
// (usd_script.h), or from JSON, as that script writes it.
//
//   {"metersPerUnit": M, "upAxis": "Y" or "Z", "timeCodesPerSecond": N, "warnings": [TEXT, ...],
//    "settings": {"path": P, "resolution": [W, H] or null, "pixelAspectRatio": A, "aspectRatioConformPolicy": WORD}
//                or null,
//    "cameras": [{"path": P, "projection": "perspective",
//                 "frames": [{"time": T, "to_world": [16 numbers], "focalLength": F, ...}, ...]},
//                or {"path": P, "error": why it cannot be used}]}
//
// Apertures and focal lengths are in tenths of a scene unit: a film of 36 mm is 36 if a unit is a centimetre (USD's
// default), 360 if it is a millimetre, 0.36 if it is a metre. Cameras look along -z. An infinite number is null. An
// fStop or focusDistance of 0 says that there is no depth of field, so the lens is unknown; sparselens:fStop and
// sparselens:focusDistance, which write_usd_views() adds, then give it.
#pragma once

#include "io/usd/film_camera.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

// The values of a camera at a time, by their names in USD; "to_world" acts on row vectors.
using UsdValues = std::map<std::string, std::vector<double>, std::less<>>;

struct UsdCamera {
    std::string path;  // "/World/camera"
    std::string error; // why it cannot be used; or empty
    std::string projection = {};
    std::map<double, UsdValues> frames = {}; // by time code; more than one: it is animated

    std::string_view name() const { return std::string_view(path).substr(path.rfind('/') + 1); }
};

struct UsdCameras {
    std::string file; // for messages
    double metres_per_unit = 0.01;
    char up_axis = 'Y'; // or Z
    double frames_per_second = 24;
    FilmFit fit = FilmFit::expand;
    std::optional<Imath::V2i> resolution = {}; // of the render settings
    double pixel_aspect = 1;
    std::string warning = {};       // what the stage lacks; or empty
    std::vector<UsdCamera> cameras; // not empty
};

// Whether the file is JSON, and no stage of USD: by its name, or standard input (-).
bool is_camera_json(const std::string &path);

// Reads JSON, or a stage: its cameras at a time code, or else at all times when they change and the whole frames
// between. Throws Error, naming the file, if it cannot be read or has no camera.
UsdCameras read_usd_cameras(const std::string &path, std::optional<double> frame);

// The camera with that path, or with that last part of its path; if the name is empty, the only one, or the only one
// called "center". Throws UsageError that lists the cameras.
const UsdCamera &camera_called(const UsdCameras &usd, const std::string &name);

// The camera whose name begins the name of the file: view_0 for views/view_0.0001.exr. Null if there is none.
const UsdCamera *camera_of_file(const UsdCameras &usd, const std::string &file);

// The camera at a time code; before the first frame and after the last, it is as there. Throws Error, naming the file
// and the camera, for a camera that cannot be used (orthographic, mirrored, sheared, with an aperture of 0) and for a
// time between frames.
FilmCamera film_camera(const UsdCameras &usd, const UsdCamera &camera, double time);

// Near and far plane at a time code, scene units.
Imath::V2d clipping_range(const UsdCameras &usd, const UsdCamera &camera, double time);

// What is doubtful about the camera: that the stage lacks a file, or that its focal length is implausible, as in a file
// whose writer took lengths for millimetres; not that if `focal_length_given`.
std::vector<std::string> film_warnings(const FilmCamera &film, bool focal_length_given);

} // namespace sparselens
