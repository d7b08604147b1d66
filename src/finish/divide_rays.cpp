#include "finish/divide_rays.h"

#include "base/error.h"
#include "finish/tuning.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

RayDivision divide_rays(int rays, int views, int supersample, double noise) {
    const int per_view = std::min(rays / views, FinishTuning::rays_per_view);
    if (per_view < 1)
        throw UsageError(fmt::format("`rays`: {} for each pixel are too few for {} views", rays, views));
    const int file_pixels = supersample * supersample; // that make one pixel of the picture
    RayDivision division{views, 1, per_view, 0};
    if (per_view >= file_pixels) division = {views, supersample, per_view / file_pixels, 0};
    division.per_render = (rays - division.of_views()) / 2;
    if (per_view < FinishTuning::rays_per_view) division.per_render = 0;
    division.noise = noise;
    division.alone = noise < FinishTuning::noise_that_views_do_not_reach;
    return division;
}

} // namespace sparselens
