// Views to LDI: a centre view and any number of rim views warped into the centre's pixels.
//
// No sample is invented: each one is a pixel of some view, or an average of pixels of one surface. Two samples
// belong to one surface where their perceptive depths R F / z differ by less than `surface_px` pixels.
#pragma once

#include "../base/progress.h"
#include "../deep/ldi.h"
#include "../lens/thin_lens.h"
#include "../view/view.h"

#include <optional>
#include <span>

namespace sparselens {

enum class Merge {
    // Rim samples join the centre samples of the same surface, weighted; the rest are averaged with each other, and
    // cover what the views' majority gives them (visibility_vote.h).
    average,
    keep, // one sample a surface, the centre's where it has one; nothing in front of the centre's sample
};

struct WarpOptions {
    double focal_px = 1; // focal length, pixels
    double radius = 0;   // aperture radius that perceptive depth is measured at, scene units
    Merge merge = Merge::average;
    double surface_px = one_surface_px;
    bool split_silhouettes = true; // average: pixels that mix two surfaces become two samples (silhouettes.h)
    bool test_photo_consistency =
        true;                         // average: not where views disagree, out of focus (photo_consistency.h)
    std::optional<double> focus = {}; // of the lens, if known, scene units
};

// views[0] is the centre; its windows and channels are the LDI's. The result does not depend on the order of the
// others. Rim channels are matched by name. Throws Error where display windows differ or a rim view lacks a
// channel of the centre.
Ldi warp(std::span<const View> views, const WarpOptions &options, Progress &progress);

} // namespace sparselens
