#include "finish/lens_headers.h"

#include "finish/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

bool differ(double a, double b) {
    return a != b && std::abs(a - b) >= FinishTuning::lens_difference * std::max(std::abs(a), std::abs(b));
}

// The radius of the aperture, mm.
std::optional<double> radius_of(const Camera &camera) {
    if (!camera.focal_length_mm || !camera.fstop) return {};
    return *camera.focal_length_mm / (2 * *camera.fstop);
}

std::optional<double> focus_metres(const Camera &camera) {
    if (!camera.focus_distance) return {};
    return *camera.focus_distance * camera.metres_per_unit.value_or(1);
}

// Between 0 and half a side of the polygon, degrees.
double turned(double a, double b, double blades) { return std::abs(std::remainder(a - b, 360 / blades)); }

std::string with_blades(double blades) {
    return blades > 0 ? fmt::format("{:g} blades", blades) : std::string("no blades");
}

} // namespace

std::vector<std::string> lens_differences(const Camera &gathered, const Camera &render) {
    std::vector<std::string> found;
    const auto radius = radius_of(gathered), other_radius = radius_of(render);
    if (radius && other_radius && differ(*radius, *other_radius))
        found.push_back(fmt::format("an aperture of {:.4g} mm radius, not {:.4g}", *other_radius, *radius));
    const auto focus = focus_metres(gathered), other_focus = focus_metres(render);
    if (focus && other_focus && differ(*focus, *other_focus))
        found.push_back(fmt::format("focus at {:.4g} m, not {:.4g}", *other_focus, *focus));
    const LookValues &looks = gathered.looks, &other = render.looks;
    const double squeeze = looks.squeeze.value_or(1), other_squeeze = other.squeeze.value_or(squeeze);
    if (differ(squeeze, other_squeeze))
        found.push_back(fmt::format("a squeeze of {:.4g}, not {:.4g}", other_squeeze, squeeze));
    if (!looks.blades || !other.blades) return found;
    const double blades = *looks.blades, rotation = looks.rotation.value_or(0),
                 other_rotation = other.rotation.value_or(0);
    if (blades != *other.blades)
        found.push_back(with_blades(*other.blades) + ", not " + with_blades(blades));
    else if (blades > 0 && turned(rotation, other_rotation, blades) > FinishTuning::turned_degrees)
        found.push_back(fmt::format("blades turned by {:.4g} degrees, not {:.4g}", other_rotation, rotation));
    return found;
}

} // namespace sparselens
