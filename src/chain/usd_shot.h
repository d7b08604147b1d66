// The views of a shot as a layer of USD: from a camera of USD alone, or frame by frame from plans of centre views.
#pragma once

#include "chain/notices.h"
#include "chain/plan_views.h"
#include "chain/stated_camera.h"
#include "io/usd/usd_views.h"

#include <optional>

namespace sparselens {

struct ShotRequest {
    CameraRequest camera; // without a frame: all frames of the camera
    LensValues lens = {};
    int views = 4;
    std::optional<Imath::V2i> size = {}; // of the picture; empty: of the render settings
};

// The views of a camera of USD: an even ring on the rim of its lens. Throws UsageError if a value is unknown.
UsdViews views_of_shot(const ShotRequest &request, const Notify &notify);

// Adds the cameras of a plan at a frame, or of a still picture. Views of other lens points than before are added to
// those of all frames. Throws Error, naming the centre view, if its camera's position is unknown, or if its size or
// scene unit is not that of the frames before.
void add_planned(UsdViews &views, const PlannedViews &planned, std::optional<int> frame);

} // namespace sparselens
