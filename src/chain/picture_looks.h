// The looks of the lens that a picture is taken with, and the picture's header that says so.
#pragma once

#include "../base/image.h"
#include "../lens/lens_looks.h"
#include "../lens/thin_lens.h"
#include "../view/camera.h"
#include "../io/lens_file.h"

#include <ImfHeader.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace sparselens {

// What was given, else what the camera says. The camera then says the same, and the header names the lens. `lens` is that
// of the picture. Throws as resolve_looks() does.
LensLooks picture_looks(const LensFile &given, Camera &camera, Imf::Header &header, const ThinLens &lens,
                        const Windows &windows);

// What to warn of where the method `name` takes the aperture for round; empty if the looks say nothing else.
std::optional<std::string> warning_of_round_aperture(const LookValues &looks, const std::string &name);

// Throws UsageError where a parameter is given that belongs to another gather method, and would have no effect.
void refuse_ignored(std::string_view method,
                    const std::function<bool(const std::string &parameter)> &is_given);

} // namespace sparselens
