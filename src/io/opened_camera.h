// The camera of an opened file.
#pragma once

#include "base/image.h"
#include "io/camera/camera_read.h"
#include "io/usd/film_camera.h"
#include "view/camera.h"

#include <ImfHeader.h>

#include <optional>
#include <string>

namespace sparselens {

// The camera that the options state, else that of the header, for which it throws as read_perspective_camera() does.
// The values of OpenOptions::lens are not applied. `windows` are the picture's.
inline Camera opened_camera(const Imf::Header &header, const std::string &name,
                            const std::optional<FilmCamera> &stated, const Windows &windows) {
    return stated ? with_film(*stated, read_camera(header), windows) : read_perspective_camera(header, name);
}

} // namespace sparselens
