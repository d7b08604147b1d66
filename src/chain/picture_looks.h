// The looks of the lens that a picture is taken with, and the picture's header that says so.
#pragma once

#include "../base/image.h"
#include "../io/lens_file.h"
#include "../lens/lens_looks.h"
#include "../lens/thin_lens.h"
#include "../view/camera.h"

#include <ImfHeader.h>

#include <optional>
#include <string>

namespace sparselens {

// read_looks() (io/lens_file.h), which keeps what the last files said: one of them may be a pipe.
class LooksReader {
public:
    LensFile read(const GivenLooks &given, std::optional<double> fstop);

private:
    std::string lens_file_, aperture_file_;
    std::optional<double> fstop_;
    std::optional<LensFile> said_;
};

// What was given, else what the camera says. The camera then says the same, and the header names the lens. `lens` is that
// of the picture. Throws as resolve_looks() does.
LensLooks picture_looks(const LensFile &given, Camera &camera, Imf::Header &header, const ThinLens &lens,
                        const Windows &windows);

// Whether a method that takes the aperture for round misses what they say.
bool shape_aperture(const LookValues &looks);

} // namespace sparselens
