// From views to an LDI: a centre view and any number of rim views are warped into the pixels of the centre view.
//
// A sample is a pixel of some view, or an average of pixels of one surface. Samples seen past it may fill it up
// (coverage.h), and surfaces continue a little behind nearer ones (extend_surfaces.h). Two samples belong to the
// same surface if their disparities R F / z differ by less than `surface_px` pixels.
#pragma once

#include "../base/progress.h"
#include "../deep/ldi.h"
#include "../lens/thin_lens.h"
#include "../view/view.h"

#include <optional>
#include <span>
#include <vector>

namespace sparselens {

class WarpDevice;  // warp/warp_device.h
struct PackedView; // deep/view_samples.h

enum class Merge {
    // Rim samples are averaged, by weight, with the centre sample of the same surface; the others are averaged with
    // each other, with the coverage that the vote of the views gives them (coverage.h).
    average,
    keep, // one sample per surface, the centre's if it has one; nothing in front of the centre sample
};

struct WarpOptions {
    double focal_px = 1; // focal length, pixels
    double radius = 0;   // the aperture radius that disparity refers to, scene units
    Merge merge = Merge::average;
    double surface_px = one_surface_px;
    // With Merge::average: pixels that mix two surfaces become two samples (silhouettes.h).
    bool split_silhouettes = true;
    // With Merge::average: views that disagree out of focus are not averaged (photo_consistency.h).
    bool test_photo_consistency = true;
    // With the test of photo-consistency: what mirrors and glass show gets a depth of its own (images/image_depths.h).
    bool find_images = true;
    // With Merge::average: surfaces continue behind nearer ones (extend_surfaces.h).
    bool extend_surfaces = true;
    std::optional<double> focus = {}; // of the lens, if known, scene units
    int across = 1; // pixels, across and down, that become one of the picture (base/subpixels.h)
    WarpDevice *device = nullptr; // if given, works on the rows that it can
};

// Takes the lens, and `across`, from the camera of the centre view, views[0]. Disparity refers to the lens radius, or
// to the distance of the outermost view if that is larger or the radius unknown. A single view needs no lens. Throws
// UsageError if the focal length is unknown.
WarpOptions with_lens(WarpOptions options, const Camera &camera, std::span<const View> views);
WarpOptions with_lens(WarpOptions options, const Camera &camera, const std::vector<PackedView> &views);

// views[0] is the centre, whose windows and channels the LDI has. The result does not depend on the order of the
// others. Channels of rim views are matched by name. Throws Error if display windows differ or a rim view lacks a
// channel of the centre view.
Ldi warp(std::span<const View> views, const WarpOptions &options, Progress &progress);
// The same in less memory: takes the pixels of the views.
Ldi warp(std::vector<View> &&views, const WarpOptions &options, Progress &progress);
Ldi warp(std::vector<PackedView> &&views, const WarpOptions &options, Progress &progress);

} // namespace sparselens
