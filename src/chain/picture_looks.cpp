#include "chain/picture_looks.h"

#include "io/exr/header_values.h"
#include "view/resolve_looks.h"

#include <ImfStringAttribute.h>

namespace sparselens {

LensFile LooksReader::read(const GivenLooks &given, std::optional<double> fstop) {
    if (!said_ || lens_file_ != given.lens_file || aperture_file_ != given.aperture_file || fstop_ != fstop) {
        said_ = read_looks({{}, given.lens_file, given.aperture_file}, fstop);
        lens_file_ = given.lens_file;
        aperture_file_ = given.aperture_file;
        fstop_ = fstop;
    }
    LensFile looks = *said_;
    looks.values = look_values_over(given.values, looks.values);
    return looks;
}

LensLooks picture_looks(const LensFile &given, Camera &camera, Imf::Header &header, const ThinLens &lens,
                        const Windows &windows) {
    camera.looks = look_values_over(given.values, camera.looks);
    if (!given.name.empty()) set_attribute(header, "lensModel", Imf::StringAttribute(given.name));
    return resolve_looks(camera.looks, camera, lens, windows);
}

bool shape_aperture(const LookValues &looks) {
    return looks.blades.value_or(0) != 0 || looks.squeeze.value_or(1) != 1;
}

} // namespace sparselens
