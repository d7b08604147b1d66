// Scenes and settings for tests, small enough for closed forms.
#pragma once

#include "base/progress.h"
#include "lab/trace/render.h"
#include "lab/trace/scenes.h"

namespace sparselens::lab {

// The default lens of most scenes, at any size: F = width.
inline RenderSettings settings_of_size(int width, int height, double radius = 0.06) {
    RenderSettings settings;
    settings.windows = windows_of_size(width, height);
    settings.lens = {.radius = radius, .focal_px = double(width), .focus = 5, .pixel_aspect = 1};
    return settings;
}

inline Paint white_light(const Imath::V3d &) { return {{1, 1, 1}, 1, true}; }
inline Paint grey(const Imath::V3d &) { return {{0.5f, 0.5f, 0.5f}}; }
inline Paint half_red(const Imath::V3d &) { return {{1, 0, 0}, 0.5f, true}; }
inline Paint blue_light(const Imath::V3d &) { return {{0, 0, 1}, 1, true}; }

// A quad that faces the camera at depth z.
inline Quad facing_quad(double x0, double y0, double x1, double y1, double z, Material material) {
    return {{{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}}, material};
}

inline Quad facing_wall(double z, Material material) {
    return facing_quad(-100, -100, 100, 100, z, material);
}

} // namespace sparselens::lab
