// The light of a small lamp out of focus: exactly how much of the aperture's picture, scaled by the CoC and mirrored in
// front of focus, lies in each pixel. Each colour sums to 1 over all pixels.
#pragma once

#include "lens/aperture.h"
#include "lens/cat_eye.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cstddef>
#include <span>
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

// Defines a lamp: a light so much brighter than its surroundings that its disc shows, while other samples out of focus
// blur into each other. All searches for lamps use these thresholds, and differ only in what they take for the
// surroundings:
// - highlights, which are spread exactly (dof/lens/highlights.h): the samples of the windows in which the lamp lies;
// - lamps that the border of the picture cuts off (dof/lens/beyond/frame_extension.h): the samples beside the lamp
//   along the border;
// - whether light beyond the frame would show (dof/border_reach.h): nearly all samples of the border;
// - the lamps of a view (warp/lamps/lamp_light.h): the pixels of the lamp's block; its brightest pixel must stand
// out by twice the factor;
// - light between strands (warp/matting/thin_structures.h): the strands.
struct LampTuning {
    // A lamp is brighter than its surroundings by this factor.
    static constexpr float stands_out = 4;
    // The factor for the brightest pixel of a lamp that is compared between views.
    static constexpr float stands_out_of_view = 8;
    // One in this number of samples may belong to a lamp; the others are its surroundings.
    static constexpr std::size_t one_in = 5;
    // The same number along the whole border.
    static constexpr std::size_t one_in_border = 32;
};

template <typename Light>
bool stands_out(Light brightness, Light surroundings, float times = LampTuning::stands_out) {
    return brightness > Light(times) * surroundings;
}

// The brightness below which all samples but one in `one_in` lie; 0 if there are no samples. Changes their order.
inline float surroundings_of(std::span<float> brightness, std::size_t one_in) {
    if (brightness.empty()) return 0;
    const auto level = brightness.end() - 1 - std::ptrdiff_t(brightness.size() / one_in);
    std::nth_element(brightness.begin(), level, brightness.end());
    return *level;
}

struct CoveredLight {
    float brightness, covers;
};

// The same, if each sample counts by what it covers: many thin layers in front of a surface do not outvote it.
inline float surroundings_of(std::span<CoveredLight> light, std::size_t one_in) {
    double all = 0, brighter = 0; // what is covered: by all, and by those that are too bright
    for (const CoveredLight &l : light) all += double(l.covers);
    while (light.size() > 1) {
        const std::size_t half = light.size() / 2;
        std::nth_element(light.begin(), light.begin() + std::ptrdiff_t(half), light.end(),
                         [](const auto &a, const auto &b) { return a.brightness < b.brightness; });
        double upper = brighter;
        for (const CoveredLight &l : light.subspan(half)) upper += double(l.covers);
        if (double(one_in) * upper > all) {
            light = light.subspan(half);
        } else {
            brighter = upper;
            light = light.first(half);
        }
    }
    return light.empty() ? 0 : light[0].brightness;
}

} // namespace sparselens
