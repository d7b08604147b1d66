#include "chain/stated_camera.h"

#include "base/error.h"
#include "io/usd/usd_transform.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

StatedCameras::StatedCameras(const CameraRequest &request)
    : request_(request), usd_(request.file.empty() ? nullptr : std::make_unique<UsdCameras>(request.file)) {}

FilmCamera StatedCameras::at_frame(const UsdPath &camera) const {
    if (!request_.frame && is_animated(camera))
        throw UsageError(
            fmt::format("{}<{}> is animated: give `camera_frame`", usd_->layer.file, text_of(camera)));
    return film_camera(*usd_, camera, request_.frame.value_or(0));
}

std::optional<FilmCamera> StatedCameras::of_centre(const std::string &file) const {
    if (!usd_) return {};
    const UsdPath *by_file = request_.name.empty() ? camera_of_file(*usd_, file) : nullptr;
    return at_frame(by_file ? *by_file : camera_called(*usd_, request_.name));
}

std::vector<std::optional<FilmCamera>> StatedCameras::of_views(const std::vector<std::string> &files,
                                                               FilmCamera &centre) const {
    std::vector<std::optional<FilmCamera>> found(files.size());
    const std::string *missing = nullptr;
    std::size_t count = 0;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const UsdPath *camera = camera_of_file(*usd_, files[i]);
        if (camera)
            found[i] = at_frame(*camera), ++count;
        else if (!missing)
            missing = &files[i];
    }
    if (count > 0 && missing)
        throw UsageError(
            fmt::format("{}: {} has no camera of this name, but one for other views; name files as "
                        "cameras are named (view_0.exr, view_0.0001.exr)",
                        *missing, usd_->layer.file));
    centre.places = files.empty() || count > 0;
    if (count == 0) std::ranges::fill(found, centre);
    return found;
}

std::optional<std::string> stated_warning(const std::optional<FilmCamera> &film, const LensValues &lens) {
    return film && !lens.focal_length_mm ? film_warning(*film) : std::nullopt;
}

} // namespace sparselens
