// The rays of a pixel through a lens with looks: the direction of each ray for each colour, and the weight of its
// light.
#pragma once

#include "lab/trace/render.h"
#include "lens/cat_eye.h"
#include "lens/focus_field.h"

#include <array>

namespace sparselens::lab {

class LookRays {
public:
    explicit LookRays(const RenderSettings &settings);

    // A lens point, and whether light passes from it to p (pixels).
    LensPoint lens_point(const Imath::V2d &square) const { return aperture_.at(square); }
    bool passes(const LensPoint &point, const Imath::V2d &p) const {
        return !cat_eye_.cuts() || cat_eye_.passes(point.u, p);
    }
    bool darkens() const { return cat_eye_.darkens(); }
    bool two_sided() const { return aperture_.two_sided(); }
    bool one_ray() const { return looks_.chromatic_coc == std::array<double, 3>{0, 0, 0}; } // for all colours

    // The inverse of the focus distance at p for R, G or B (0, 1 or 2); 0 or less is at infinity or beyond.
    double inverse_focus(const Imath::V2d &p, std::size_t colour) const;
    Ray ray(const Imath::V2d &u, const Imath::V2d &p, double inverse_focus, double time) const;

private:
    Imath::V2d without_breathing(const Imath::V2d &p) const {
        return frame_.magnified(p, 1 / looks_.magnification);
    }

    const RenderSettings &settings_;
    LensLooks looks_;
    Aperture aperture_;
    PictureFrame frame_;
    FocusField field_;
    CatEye cat_eye_;
};

// As render_reference(), with these rays: the weighted mean of what they meet.
Image render_looks(const Tracer &tracer, const RenderSettings &settings, int samples, Progress &progress);

} // namespace sparselens::lab
