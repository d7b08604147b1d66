// How far the lens spreads light: the circle of confusion, with all that the looks make of it.
//
// The CoC grows by what a bent or tilted plane of focus and axial chromatic aberration add, is as wide as the aperture is
// for each pixel of it (1 / S of a lens squeezed by S < 1), is skewed by astigmatism, is stretched where the plane is steep (focus_field.h), and is
// magnified with the picture.
#pragma once

#include "base/image.h"
#include "lens/focus_field.h"
#include "lens/lens_looks.h"
#include "lens/picture_frame.h"
#include "lens/thin_lens.h"

#include <Imath/ImathBox.h>

namespace sparselens {

class LightReach {
public:
    // `windows`: of the picture.
    LightReach(const ThinLens &lens, const LensLooks &looks, const Windows &windows);

    // In x and y, pixels, what the ray through the middle of the lens shows at p (EXR coordinates), `coc` being that of a flat
    // plane of focus; before the picture is magnified.
    Imath::V2d at(const Imath::V2d &p, double coc) const;

    // Where the magnified picture may show it.
    Imath::Box2d box(const Imath::V2d &p, double coc) const;

    // Where lies what the magnified picture shows at p.
    Imath::V2d shown_at(const Imath::V2d &p) const { return frame_.magnified(p, 1 / magnification_); }
    double magnification() const { return magnification_; }

private:
    PictureFrame frame_;
    FocusField field_;
    Imath::V2d extent_;                               // of the aperture, for each pixel of CoC
    double least_chromatic_ = 0, most_chromatic_ = 0; // what is added to the CoC of a colour
    double magnification_;
};

} // namespace sparselens
