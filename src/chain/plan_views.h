// Plans which views are worth rendering in addition to the centre view, and how many moments of a shutter; and gives
// the views of a shot as a layer of USD, from a camera of USD alone, or frame by frame from plans of centre views.
#pragma once

#include "chain/notices.h"
#include "chain/stated_camera.h"
#include "io/open_view.h"
#include "io/plan_file.h"
#include "io/usd/usd_views.h"
#include "plan/block_motion.h"
#include "plan/disocclusion.h"
#include "plan/plan.h"

#include <cstddef>
#include <optional>

namespace sparselens {

struct PlannedViews {
    Plan plan;
    PlanSetting setting;
    Camera camera; // of the centre view, with the lens and the sub-pixels of the plan
};

// `lens` and `supersample` override the view's values. `rays`: all rays of a pixel, to divide (plan.h).
PlannedViews plan_views(const OpenedView &centre, PlanOptions options, const LensValues &lens,
                        std::optional<int> supersample, std::optional<int> rays, Progress &progress,
                        const Notify &notify);

// Tells from the centre views of a shutter's moments how many moments it needs (plan/block_motion.h). `first` and
// `last` are the first and the last of so many moments, at least 2, with the lens of the plan. The camera's motion
// follows from their matrices, if they have them; else all motion is found in the pictures. Empty if the pictures do
// not tell. Throws Error, naming both files, if their sizes differ.
std::optional<MomentsNeed> plan_moments(const OpenedView &first, const OpenedView &last, std::size_t moments,
                                        const PlannedViews &planned, const LensValues &lens);

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
