#include "io/opened_camera.h"

#include "io/camera/camera_read.h"

namespace sparselens {

Camera opened_camera(const Imf::Header &header, const std::string &name,
                     const std::optional<FilmCamera> &stated, const Windows &windows) {
    return stated ? with_film(*stated, read_camera(header), windows) : read_perspective_camera(header, name);
}

} // namespace sparselens
