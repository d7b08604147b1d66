// The light of a small lamp out of focus: exactly how much of the aperture's picture, scaled by the CoC and mirrored in
// front of focus, lies in each pixel. The whole of it sums to 1, of each colour.
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
    Imath::V2d skew{0, 0}; // FocusField::skew(), which LampCells alone know
};

// Weights of the pixels of a box that the light reaches.
struct LampSpread {
    Imath::Box2i box; // empty: none
    bool coloured = false;
    std::vector<double> weights; // [row][column]
    // the same of R, G and B, if coloured; then weights are their mean
    std::vector<std::array<double, 3>> colours;
};

// What a cat-eye leaves of a lamp's light: that through the places a on the lens with |scale a - centre| <= 1. The middle of
// the second circle moves in proportion to how far the light is displaced, so that this is a circle too.
struct LampCut {
    Imath::V2d scale, centre;
};
LampCut cut_of(const CatEye &cat_eye, const Aperture &aperture, const Lamp &lamp);

// Within `box`, at most as large as it must be. The aperture is not a disc (lens/psf.h has those), unless a cat-eye cuts
// it; what that leaves sums to less than 1.
LampSpread spread_lamp(const Aperture &aperture, const Lamp &lamp, const Imath::Box2i &box,
                       const LampCut *cut = nullptr);

} // namespace sparselens
