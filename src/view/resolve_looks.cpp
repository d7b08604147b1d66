#include "view/resolve_looks.h"

#include "view/view_mapping.h"

namespace sparselens {

LensLooks resolve_looks(const LookValues &values, const Camera &camera, const ThinLens &lens,
                        const Windows &windows) {
    LensLooks looks;
    values.act({lens, camera.focal_length_mm, camera.metres_per_unit.value_or(1)}, looks);
    looks.aperture.picture = values.picture;
    if (camera.principal_point)
        looks.axis = in_pixels(*camera.principal_point, windows) - in_pixels({0, 0}, windows);
    return looks;
}

} // namespace sparselens
