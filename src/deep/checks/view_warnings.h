// What is said of views that show a mistake, each in one sentence that names the view and says what to do. What is checked
// stands beside this file; a warning needs a clear finding over many pixels, for a false one is worse than none.
#pragma once

#include "../../view/camera.h"
#include "../../view/depth.h"
#include "../../view/view.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct PackedView; // deep/packed_view.h

// What is known of views beside their pixels.
struct ViewFacts {
    DepthMeaning depth = DepthMeaning::planar; // as what they were read
    bool depth_filtered = false;               // of the first view: see edge_depths.h
    Camera camera = {};                        // of the first view
    bool unpremultiplied = false;              // of the first view: see premultiplied_check.h
};

// Of the first view, which is the centre or the only one: its colours, its depths, and what the lens makes of them. Colours
// are linear by now, if they are what they are said to be.
std::vector<std::string> picture_warnings(const View &view, const ViewFacts &facts);

// That, and whether the views stand where they are said to.
std::vector<std::string> view_warnings(std::span<const View> views, const ViewFacts &facts);
std::vector<std::string> view_warnings(const std::vector<PackedView> &views, const ViewFacts &facts);

} // namespace sparselens
