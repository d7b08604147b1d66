#include "chain/picture_looks.h"

#include "base/error.h"
#include "io/exr/header_edit.h"
#include "view/resolve_looks.h"

#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>

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

void refuse_ignored(std::string_view method,
                    const std::function<bool(const std::string &parameter)> &is_given) {
    const auto only_with = [&](const std::string &name, std::string parameter) {
        std::ranges::replace(parameter, '-', '_');
        if (name != method && is_given(parameter))
            throw UsageError(fmt::format("`{}`: works with `method={}` only", parameter, name));
    };
    for (const char *parameter : {"quality", "lens_samples", "layer_tolerance", "holdout", "lens_point",
                                  "lens", "aperture", "tilt", "cat_eye_darkening", "axial_chromatic_type"})
        only_with("lens", parameter);
    for (const LookNumber &look : look_numbers()) only_with("lens", look.name);
    only_with("selective", "layers");
}

} // namespace sparselens
