#include "chain/stated_camera.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

std::string stage_of(const CameraRequest &request) {
    return is_camera_json(request.file) ? "" : request.file;
}

StatedCameras::StatedCameras(const CameraRequest &request) : request_(request) {
    if (!request.file.empty()) usd_ = read_usd_cameras(request.file, request.frame);
}

FilmCamera StatedCameras::at_frame(const UsdCamera &camera) const {
    if (!request_.frame && camera.frames.size() > 1)
        throw UsageError(fmt::format("{}<{}> is animated: give `camera_frame`", usd_->file, camera.path));
    return film_camera(*usd_, camera, request_.frame.value_or(0));
}

const UsdCamera *StatedCameras::centre(const std::string &file) const {
    if (!usd_) return nullptr;
    const UsdCamera *by_file = request_.name.empty() ? camera_of_file(*usd_, file) : nullptr;
    return by_file ? by_file : &camera_called(*usd_, request_.name);
}

std::optional<FilmCamera> StatedCameras::of_centre(const std::string &file) const {
    const UsdCamera *camera = centre(file);
    return camera ? std::optional(at_frame(*camera)) : std::nullopt;
}

std::vector<std::optional<FilmCamera>> StatedCameras::of_views(const std::vector<std::string> &files,
                                                               FilmCamera &centre) const {
    std::vector<std::optional<FilmCamera>> found(files.size());
    const std::string *missing = nullptr;
    std::size_t count = 0;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const UsdCamera *camera = camera_of_file(*usd_, files[i]);
        if (camera)
            found[i] = at_frame(*camera), ++count;
        else if (!missing)
            missing = &files[i];
    }
    if (count > 0 && missing)
        throw UsageError(
            fmt::format("{}: {} has no camera of this name, but one for other views; name files as "
                        "cameras are named (view_0.exr, view_0.0001.exr)",
                        *missing, usd_->file));
    centre.places = files.empty() || count > 0;
    if (count == 0) std::ranges::fill(found, centre);
    return found;
}

std::vector<std::string> stated_warnings(const std::optional<FilmCamera> &film, const LensValues &lens) {
    return film ? film_warnings(*film, lens.focal_length_mm.has_value()) : std::vector<std::string>();
}

} // namespace sparselens
