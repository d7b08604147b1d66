// Deep pictures as renderers write them for hair, smoke and leaves: many samples per pixel, most of them of partial
// coverage. They serve to measure the time and the memory that such files take. The same arguments give the same
// picture.
#pragma once

#include "deep/ldi.h"
#include "view/view.h"

#include <span>

namespace sparselens {

// A scene by name, with channels R, G, B and A (half) unless noted. CoC is for deep_scene_camera().
//
// dense   20 points per pixel in five groups, CoC 0.25 to 4.2 pixels, the last opaque: the profile scene that DeepC
//         publishes for its DeepCDefocus
// hair    60 points in a tenth of the pixels, in tufts of 32x64 pixels, CoC -3 to 1; a ground at CoC 6 behind all
// apart   20 points per pixel, half a pixel of CoC apart from -4 on, the last opaque: none can be merged
// tinted  the points of dense with per-channel alpha: AR, AG and AB besides A
// volume  100 volumes per pixel, end to end, CoC -4 to 6; transparent to infinity
struct DeepScene {
    const char *name;
    Ldi (*make)(int width, int height);
};
std::span<const DeepScene> deep_scenes();

// The camera of all scenes: a lens of 50 mm before a sensor of 36 mm, focused on 10, such that R F / focus is 20
// pixels.
Camera deep_scene_camera(int width);

} // namespace sparselens
