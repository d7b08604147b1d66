#include "chain/plan_moments.h"

#include "chain/same_shutter.h"
#include "io/moment_files.h"
#include "view/camera_motion.h"

namespace sparselens {

namespace {

// The part of the shutter's time between two moments: as the files state it, else the files are all moments.
double part_between(const OpenedView &first, const OpenedView &last, std::size_t moments) {
    const auto one = stated_moment(first.header), other = stated_moment(last.header);
    if (one && other && one->moments == other->moments && other->moment > one->moment)
        return double(other->moment - one->moment) / other->moments;
    return double(moments - 1) / double(moments);
}

} // namespace

std::optional<MomentsNeed> plan_moments(const OpenedView &first, const OpenedView &last, std::size_t moments,
                                        const PlannedViews &planned, const LensValues &lens) {
    const View &view = first.view;
    const Windows &windows = view.image.windows;
    require_same_size({view.name, windows}, {last.view.name, last.view.image.windows});
    const auto camera = camera_motion(camera_with_options(lens, first.camera),
                                      camera_with_options(lens, last.camera), windows);
    const auto expected = [&](const Imath::V2i &pixel) {
        const Imath::V2d middle = Imath::V2d(pixel) + Imath::V2d(0.5);
        const double z = double(view.z[windows.index(pixel.x, pixel.y)]);
        return camera && z > 0 ? camera->moved(middle, z) - middle : Imath::V2d(0);
    };
    return moments_needed(view, last.view, planned.setting.lens, expected, part_between(first, last, moments),
                          planned.setting.across);
}

} // namespace sparselens
