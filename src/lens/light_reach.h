// How far the lens spreads light: the circle of confusion, with all changes by the looks.
//
// A bent or tilted plane of focus and axial chromatic aberration add to the CoC. The CoC is scaled by the width of the
// aperture (1 / S for a lens squeezed by S < 1), skewed by astigmatism, stretched where the plane is steep
// (focus_field.h), and magnified with the picture.
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
    // `windows`: the picture's.
    LightReach(const ThinLens &lens, const LensLooks &looks, const Windows &windows);

    // The reach in x and y, in pixels, of the sample that the ray through the middle of the lens shows at p (EXR
    // coordinates), before the picture is magnified. `coc`: the sample's CoC with a flat plane of focus.
    Imath::V2d at(const Imath::V2d &p, double coc) const;

    // The box in which the magnified picture may show the sample.
    Imath::Box2d box(const Imath::V2d &p, double coc) const;

    // The place, before magnification, of the point that the magnified picture shows at p.
    Imath::V2d shown_at(const Imath::V2d &p) const { return frame_.magnified(p, 1 / magnification_); }
    double magnification() const { return magnification_; }

private:
    PictureFrame frame_;
    FocusField field_;
    Imath::V2d extent_;                               // of the aperture, per pixel of CoC
    double least_chromatic_ = 0, most_chromatic_ = 0; // limits of the offsets of colours' CoC
    double magnification_;
};

} // namespace sparselens
