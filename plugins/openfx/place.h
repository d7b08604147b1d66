// The place of a host's pixels in a picture of dof-gather. A host counts rows upwards from the lower edge of the display
// window, in pixels of its render scale; EXR counts them downwards, in pixels of a proxy.
#pragma once

#include <algorithm>
#include <cmath>

namespace sparselens_ofx {

struct Box {
    int x0 = 0, y0 = 0, x1 = -1, y1 = -1; // EXR coordinates, the last pixels included
    bool is_empty() const { return x1 < x0 || y1 < y0; }
};
inline Box intersection(const Box &a, const Box &b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

// The proxy that is made for a render scale: the smallest picture with at least as many pixels.
inline int proxy_for(double scale) {
    constexpr double most = 1024; // of dof-gather
    return int(std::clamp(std::floor(1 / scale + 1e-6), 1.0, most));
}

struct Place {
    Box display;                     // of the full-size picture
    double scale_x = 1, scale_y = 1; // of the host: its pixels for one of the full-size picture
    int proxy = 1;                   // this many pixels of the full-size picture, across and down, are one
    int left = 0, bottom = 0;        // the host's pixel in the lower left corner of the display window

    // The proxy's pixel that contains the middle of the host's pixel. Scale 1/N and proxy N have the same pixels.
    int column(int x) const { return int(std::floor(((x - left + 0.5) / scale_x + display.x0) / proxy)); }
    int row(int y) const { return int(std::floor((display.y1 + 1 - (y - bottom + 0.5) / scale_y) / proxy)); }
};

} // namespace sparselens_ofx
