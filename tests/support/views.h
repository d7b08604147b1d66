// Views made from a formula, with any number of cameras: two textured planes that face the camera.
#pragma once

#include "view/view.h"

#include <functional>
#include <vector>

namespace sparselens {

// A point-sampled pixel of a view; alpha 0: nothing is there.
struct ViewPixel {
    float z = 1;
    float r = 0, g = 0, b = 0, a = 1;
};

// pixel(x, y) gives every pixel of the data window, in EXR coordinates. Channels R, G, B, A.
View make_view(const Windows &windows, const Imath::V2d &position,
               const std::function<ViewPixel(int x, int y)> &pixel);

// A front plane with holes before a back plane. Positions on both are given by where the centre view shows them, in
// pixels (its optical axis goes through the middle of the display window); the picture of a camera at `position`
// follows along the rays of its pixels.
struct TwoPlanes {
    double focal_px = 100;
    double front_z = 2, back_z = 10;
    std::function<bool(double x, double y)> front_covers = [](double, double) { return false; };
    std::function<float(double x, double y)> front_red = [](double, double) { return 1.0f; };
    std::function<float(double x, double y)> back_green = [](double, double) { return 1.0f; };
    float noise = 0; // each pixel of each view is brighter or darker by up to this

    View view(const Windows &windows, const Imath::V2d &position, const Framing &framing = {}) const;
};

// The centre, then rim views to the right, above, to the left and below. `view_from` makes the view from a lens point.
std::vector<View> five_views(const std::function<View(const Imath::V2d &u)> &view_from);
std::vector<View> five_views(const TwoPlanes &scene, const Windows &windows, double radius);

// Random depths from a small set, random colours, some pixels empty, some infinitely far: the views are inconsistent.
View random_view(const Windows &windows, const Imath::V2d &position, std::uint32_t seed);

} // namespace sparselens
