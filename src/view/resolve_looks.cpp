#include "view/resolve_looks.h"

#include "base/error.h"
#include "lens/f_number.h"
#include "view/view_mapping.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace sparselens {

namespace {

// The focal length in mm, which this look needs.
double focal_length_for(const char *look, const Camera &camera) {
    if (camera.focal_length_mm) return *camera.focal_length_mm;
    throw UsageError(fmt::format("`{}` needs the focal length: give `focal_length`", look));
}

std::array<double, 3> chromatic_coc(const LookValues &values, const Camera &camera, const ThinLens &lens) {
    const double mm = values.axial_chromatic.value_or(0);
    if (mm == 0 || lens.radius == 0) return {0, 0, 0};
    const double focal_mm = focal_length_for("axial_chromatic", camera);
    const double coc = defocus_coc(mm, fstop_of(lens.radius, focal_mm, camera.metres_per_unit.value_or(1)),
                                   lens.focal_px / focal_mm);
    switch (values.chromatic_type.value_or(ChromaticType::red_blue)) {
    case ChromaticType::blue_yellow: return {0, 0, -coc};
    case ChromaticType::green_magenta: return {coc, 0, coc};
    case ChromaticType::red_blue: break;
    }
    return {coc, 0, -coc};
}

double magnification(const LookValues &values, const Camera &camera, const ThinLens &lens) {
    const double breathing = values.breathing.value_or(0);
    if (breathing == 0) return 1;
    const double focal = focal_length_for("breathing", camera) / 1000 / camera.metres_per_unit.value_or(1);
    if (!(lens.focus > focal))
        throw UsageError(
            "`breathing`: the focus distance must exceed the focal length: no lens focuses nearer");
    return std::pow(unit_focusing_magnification(focal, lens.focus), breathing);
}

} // namespace

LensLooks resolve_looks(const LookValues &values, const Camera &camera, const ThinLens &lens,
                        const Windows &windows) {
    LensLooks looks;
    ApertureShape &shape = looks.aperture;
    shape.blades = int(values.blades.value_or(0));
    shape.curvature = values.curvature.value_or(shape.curvature);
    shape.rotation = values.rotation.value_or(shape.rotation);
    shape.squeeze = values.squeeze.value_or(shape.squeeze);
    shape.spherical = values.spherical.value_or(0);
    shape.picture = values.picture;
    looks.cat_eye = values.cat_eye.value_or(0);
    looks.cat_eye_darkening = values.cat_eye_darkening.value_or(false);
    looks.chromatic_coc = chromatic_coc(values, camera, lens);
    looks.field_curvature = values.field_curvature.value_or(0);
    looks.astigmatism = values.astigmatism.value_or(0);
    const auto tangent = [](const std::optional<double> &degrees) {
        return std::tan(degrees.value_or(0) * std::numbers::pi / 180);
    };
    looks.tilt = {tangent(values.tilt_x), tangent(values.tilt_y)};
    looks.magnification = magnification(values, camera, lens);
    if (camera.principal_point)
        looks.axis = in_pixels(*camera.principal_point, windows) - in_pixels({0, 0}, windows);
    return looks;
}

} // namespace sparselens
