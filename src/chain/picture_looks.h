// The looks of the lens that takes a picture, and the picture's header that records them.
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

// Calls read_looks() (io/lens_file.h) and keeps the contents of the last files, because one of them may be a pipe.
class LooksReader {
public:
    LensFile read(const GivenLooks &given, std::optional<double> fstop);

private:
    std::string lens_file_, aperture_file_;
    std::optional<double> fstop_;
    std::optional<LensFile> said_;
};

// The given looks; where none are given, those of the camera. The camera then gets them, and the header names the lens.
// `lens` is that of the picture. Throws as resolve_looks() does.
LensLooks picture_looks(const LensFile &given, Camera &camera, Imf::Header &header, const ThinLens &lens,
                        const Windows &windows);

// Whether a method that treats the aperture as round would ignore some of these looks.
bool shape_aperture(const LookValues &looks);

} // namespace sparselens
