// Cameras that the user states in a file of USD, instead of those in the files of the views.
#pragma once

#include "io/usd/usd_camera.h"
#include "view/resolve_lens.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sparselens {

struct CameraRequest {
    std::string file = {};            // textual USD; empty: the cameras of the views
    std::string name = {};            // of the centre camera: its path, or the last part of it
    std::optional<double> frame = {}; // time code; needed if the camera is animated
};

class StatedCameras {
public:
    // Reads the file, if there is one. Throws as UsdCameras does.
    explicit StatedCameras(const CameraRequest &request);

    // The camera of the centre view: the one that the request names, or that has the name of its file, or the only
    // one. Empty without a request.
    std::optional<FilmCamera> of_centre(const std::string &file) const;

    // The cameras of further views: those that have the names of their files. If none has, the file does not say where
    // the views stand, and only lens and frustum of the centre camera are used, for all. Throws UsageError, naming the
    // view, if only some have.
    std::vector<std::optional<FilmCamera>> of_views(const std::vector<std::string> &files,
                                                    FilmCamera &centre) const;

    const UsdCameras *file() const { return usd_.get(); } // null without a request

private:
    FilmCamera at_frame(const UsdPath &camera) const;

    CameraRequest request_;
    std::unique_ptr<UsdCameras> usd_; // null without a request
};

// A warning if the focal length of the camera is implausible and the user has not given another.
std::optional<std::string> stated_warning(const std::optional<FilmCamera> &film, const LensValues &lens);

} // namespace sparselens
