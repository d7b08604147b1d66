#include "view/depth.h"

#include <cmath>

namespace sparselens {

bool is_sky(DepthMeaning meaning, double value, double far) {
    constexpr double largest_half = 65504;
    if (meaning == DepthMeaning::inverse) return value >= 0 && value <= 1 / far;
    return value >= far || value == largest_half;
}

double planar_depth(DepthMeaning meaning, double value, int x, int y, const Windows &windows,
                    double focal_px) {
    if (meaning == DepthMeaning::planar) return value;
    if (meaning == DepthMeaning::inverse) return 1 / (value == 0 ? 0.0 : value); // -0 too is infinitely far
    const Imath::Box2i &display = windows.display;
    const double right = x + 0.5 - 0.5 * (display.min.x + display.max.x + 1);
    const double down = (y + 0.5 - 0.5 * (display.min.y + display.max.y + 1)) / double(windows.pixel_aspect);
    return value / std::sqrt(1 + (right * right + down * down) / (focal_px * focal_px));
}

} // namespace sparselens
