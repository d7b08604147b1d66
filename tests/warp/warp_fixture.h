// Views to warp, both ways to warp them, and access to the results.
#pragma once

#include "support/ldi_samples.h"
#include "support/views.h"
#include "warp/warp.h"

#include <functional>
#include <limits>
#include <vector>

namespace sparselens::warping {

inline constexpr float inf = std::numeric_limits<float>::infinity();
inline constexpr double focal_px = 100, radius = 0.06;
// Without silhouettes and what continues behind others, which have their own tests.
inline const WarpOptions averaging{
    .focal_px = focal_px, .radius = radius, .split_silhouettes = false, .extend_surfaces = false};
inline const WarpOptions keeping{.focal_px = focal_px, .radius = radius, .merge = Merge::keep};

Ldi warped(const std::vector<View> &views, const WarpOptions &options = averaging);

void expect_same_bits(const Ldi &a, const Ldi &b);

// The samples of pixel (x, y) of an LDI whose data window may have grown.
TestPixel pixel_at(const Ldi &ldi, int x, int y);

template <typename Visit>
void for_each_pixel(const Imath::Box2i &box, const Visit &visit) {
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x) visit(x, y);
}

// Stripes of a front plane before a back plane.
TwoPlanes fence();

// One plane that fills the picture, at a depth for which rim views land between pixels.
TwoPlanes one_plane(const std::function<float(double, double)> &red);

std::vector<View> random_views(const Windows &windows, int count);

} // namespace sparselens::warping
