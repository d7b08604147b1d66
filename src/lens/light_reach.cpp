#include "lens/light_reach.h"

#include "lens/aperture.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

LightReach::LightReach(const ThinLens &lens, const LensLooks &looks, const Windows &windows)
    : frame_(picture_frame(windows, looks)), field_(looks, lens, frame_),
      magnification_(looks.magnification) {
    const Imath::V2d half = Aperture(looks.aperture).half_extent();
    extent_ = {half.x, half.y * lens.pixel_aspect};
    for (const double coc : looks.chromatic_coc) {
        least_chromatic_ = std::min(least_chromatic_, coc);
        most_chromatic_ = std::max(most_chromatic_, coc);
    }
}

Imath::V2d LightReach::at(const Imath::V2d &p, double coc) const {
    double bent = coc, steepest = 1;
    if (!field_.flat()) {
        const Imath::V2d gradient = field_.coc_gradient(p);
        bent += field_.coc_offset(p);
        steepest = stretch(gradient, gradient.normalized() * std::max(extent_.x, extent_.y));
    }
    const double largest = std::max(std::abs(bent + least_chromatic_), std::abs(bent + most_chromatic_));
    const double beside = field_.skew(p).length() / magnification_ * std::max(extent_.x, extent_.y);
    return (extent_ * largest + Imath::V2d(beside)) * steepest;
}

Imath::Box2d LightReach::box(const Imath::V2d &p, double coc) const {
    const Imath::V2d middle = frame_.magnified(p, magnification_), reach = at(p, coc) * magnification_;
    return {middle - reach, middle + reach};
}

} // namespace sparselens
