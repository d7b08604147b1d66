// Cameras that the user states in a file of USD or JSON, instead of those in the files of the views.
#pragma once

#include "io/usd/usd_camera.h"
#include "view/resolve_lens.h"

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

struct CameraRequest {
    std::string file = {};            // USD or JSON (usd_camera.h); empty: the cameras of the views
    std::string name = {};            // of the centre camera: its path, or the last part of it
    std::optional<double> frame = {}; // time code; needed if the camera is animated
};

// The file, if other attributes of its camera can be copied: a stage of USD. Otherwise empty.
std::string stage_of(const CameraRequest &request);

class StatedCameras {
public:
    // Reads the file, if there is one. Throws as read_usd_cameras() does.
    explicit StatedCameras(const CameraRequest &request);

    // The camera of the centre view: the one that the request names, or that has the name of its file, or the only
    // one. Empty without a request.
    std::optional<FilmCamera> of_centre(const std::string &file) const;

    // The cameras of further views: those that have the names of their files. If none has, the file does not say where
    // the views stand, and only lens and frustum of the centre camera are used, for all. Throws UsageError, naming the
    // view, if only some have.
    std::vector<std::optional<FilmCamera>> of_views(const std::vector<std::string> &files,
                                                    FilmCamera &centre) const;

    // Null without a request.
    const UsdCameras *file() const { return usd_ ? &*usd_ : nullptr; }
    const UsdCamera *centre(const std::string &file) const;

private:
    FilmCamera at_frame(const UsdCamera &camera) const;

    CameraRequest request_;
    std::optional<UsdCameras> usd_; // empty without a request
};

// What is doubtful about the camera; its focal length only if the user has not given another.
std::vector<std::string> stated_warnings(const std::optional<FilmCamera> &film, const LensValues &lens);

} // namespace sparselens
