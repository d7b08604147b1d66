// Plans which views are worth rendering in addition to the centre view.
#pragma once

#include "chain/notices.h"
#include "io/open_view.h"
#include "io/plan_file.h"
#include "plan/plan.h"
#include "plan/rectangles.h"

#include <optional>

namespace sparselens {

struct PlannedViews {
    Plan plan;
    PlanSetting setting;
    Camera camera; // of the centre view, with the lens and the sub-pixels of the plan
};

// `lens` and `supersample` override the view's values. `rays`: all rays of a pixel, to divide (divide_rays.h).
PlannedViews plan_views(const OpenedView &centre, PlanOptions options, const LensValues &lens,
                        std::optional<int> supersample, std::optional<int> rays, Progress &progress,
                        const Tell &tell);

} // namespace sparselens
