// The camera of an opened file.
#pragma once

#include "base/image.h"
#include "io/usd/film_camera.h"
#include "view/camera.h"

#include <ImfHeader.h>

#include <optional>
#include <string>

namespace sparselens {

// The camera that the options state, else that of the header, for which it throws as read_perspective_camera() does.
// The values of OpenOptions::lens are not applied. `windows` are the picture's.
Camera opened_camera(const Imf::Header &header, const std::string &name,
                     const std::optional<FilmCamera> &stated, const Windows &windows);

} // namespace sparselens
