// The light of a small lamp out of focus: exactly how much of the aperture's picture, scaled by the CoC and mirrored in
// front of focus, lies in each pixel. Each colour sums to 1 over all pixels.
#pragma once

#include "lens/aperture.h"
#include "lens/cat_eye.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <vector>

namespace sparselens {

struct Lamp {
    Imath::V2d centre; // EXR pixel coordinates, y down
    double coc = 0;    // signed, pixels, not 0
    double pixel_aspect = 1;
    Imath::V2d skew{0, 0}; // FocusField::skew(), used by LampCells only
};

// Weights of the pixels of a box that the light reaches.
struct LampSpread {
    Imath::Box2i box; // empty: none
    bool coloured = false;
    std::vector<double> weights; // [row][column]
    // the weights of R, G and B, if coloured; `weights` are then those of coverage
    std::vector<std::array<double, 3>> colours;
};

// The part of a lamp's light that a cat-eye leaves: light through places a on the lens with
// |scale a - centre| <= 1. The middle of the second circle moves in proportion to the light's displacement, so that
// this part is a circle too.
struct LampCut {
    Imath::V2d scale, centre;
};
LampCut cut_of(const CatEye &cat_eye, const Aperture &aperture, const Lamp &lamp);

// The lamp's light within `box`; the box of the result is as small as possible. The aperture must not be a disc (see
// lens/psf.h), unless a cat-eye cuts it; then the weights sum to less than 1.
LampSpread spread_lamp(const Aperture &aperture, const Lamp &lamp, const Imath::Box2i &box,
                       const LampCut *cut = nullptr);

} // namespace sparselens
