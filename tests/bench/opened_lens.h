// Scenes for timing gathers: many surfaces, seen by a lens that is opened further and further.
#pragma once

#include "support/lens_ldi.h"

#include <benchmark/benchmark.h>

namespace sparselens {

inline Ldi many_surfaces(int width, int height) {
    return random_surfaces(windows_of_size(width, height), {.radius = 0.06, .focal_px = 640, .focus = 5},
                           false, 1);
}

// The lens opened `range` tenths as wide: the largest CoC is 6 px at 1.
inline ThinLens opened(const benchmark::State &state) {
    return {.radius = 0.06 * double(state.range(0)) / 10, .focal_px = 640, .focus = 5};
}

} // namespace sparselens
