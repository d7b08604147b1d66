// Warnings about views that show a mistake. Each is one sentence that names the view and says what to do. The checks
// stand beside this file. A warning needs clear evidence in many pixels, because a false warning is worse than none.
#pragma once

#include "../../view/depth.h"
#include "../../view/view.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct PackedView; // deep/view_samples.h

// What the caller knows about the views besides their pixels.
struct ViewFacts {
    DepthMeaning depth = DepthMeaning::planar; // how they were read
    bool depth_filtered = false;               // in the first view; see mixed_pixels.h
    Camera camera = {};                        // of the first view
    bool unpremultiplied = false;              // in the first view; see picture_checks.h
};

// Checks the first view, which is the centre or the only one: its colours, its depths, and the blur that the lens gives
// them. Colours must have been converted to linear.
std::vector<std::string> picture_warnings(const View &view, const ViewFacts &facts);

// Checks the first view, and whether all views stand where they should.
std::vector<std::string> view_warnings(std::span<const View> views, const ViewFacts &facts);
std::vector<std::string> view_warnings(const std::vector<PackedView> &views, const ViewFacts &facts);

} // namespace sparselens
