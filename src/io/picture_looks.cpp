#include "io/picture_looks.h"

#include "io/exr/header_edit.h"
#include "view/resolve_looks.h"

#include <ImfStringAttribute.h>
#include <fmt/format.h>

namespace sparselens {

LensLooks picture_looks(const LensFile &given, Camera &camera, Imf::Header &header, const ThinLens &lens,
                        const Windows &windows) {
    camera.looks = look_values_over(given.values, camera.looks);
    if (!given.name.empty()) set_attribute(header, "lensModel", Imf::StringAttribute(given.name));
    return resolve_looks(camera.looks, camera, lens, windows);
}

std::optional<std::string> warning_of_round_aperture(const LookValues &looks, const std::string &name) {
    if (looks.blades.value_or(0) == 0 && looks.squeeze.value_or(1) == 1) return {};
    return fmt::format("method {} ignores the aperture's shape; using a disc", name);
}

} // namespace sparselens
