#include "chain/plan_views.h"

#include "chain/file_notices.h"
#include "deep/checks/view_warnings.h"
#include "finish/divide_rays.h"

#include <algorithm>

namespace sparselens {

PlannedViews plan_views(const OpenedView &centre, PlanOptions options, const LensValues &lens,
                        std::optional<int> supersample, std::optional<int> rays, Progress &progress,
                        const Tell &tell) {
    PlannedViews planned;
    planned.camera = camera_with_options(lens, centre.camera);
    if (supersample) planned.camera.supersample = supersample;
    options.across = planned.camera.supersample.value_or(1);
    const Windows &windows = centre.view.image.windows;
    planned.setting = {centre.view.name, windows, resolve_lens(planned.camera, windows), options.margin,
                       options.across};
    tell_warnings(tell, picture_warnings(centre.view, {centre.depth, centre.depth_filtered, planned.camera,
                                                       centre.unpremultiplied}));
    planned.plan = make_plan(centre.view, planned.setting.lens, options, progress);
    if (rays)
        planned.setting.division = divide_rays(*rays, int(planned.plan.views.size()) + 1,
                                               std::max(options.across, planned.plan.supersample));
    return planned;
}

} // namespace sparselens
