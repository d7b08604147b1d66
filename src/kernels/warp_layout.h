// The data that the CPU lays out for the warp on a device, and how the device divides it (gpu/warp).
#pragma once

#include "kernels/types.h"

#include <cstddef>

namespace sparselens::warp_kernel {

using kernels::uint;

inline constexpr uint none = 0xffffffffu;
inline constexpr uint threads = 256;       // of a work group
inline constexpr uint summed_at_once = 16; // numbers, by a thread (prefix_sums.comp)

struct View {
    double unzoom, approach, offset_x, offset_y, step_x, step_y; // ViewMapping
    int min_x, min_y, max_x, max_y;                              // its data window
    uint begins; // where its part of the list of first samples begins
    uint unused;
};
static_assert(sizeof(View) == 72 && offsetof(View, min_x) == 48 && offsetof(View, begins) == 64);

struct Frame {
    double tolerance, inverse_scale, focus_scale, focus; // focus_scale: R F of the lens
    double motion_unit, unused;                          // of photo_verdict()
    int first_x, first_y, width, height;                 // of the data window
    uint views, samples, channels, alpha;                // alpha: the channel, or `none`
    uint colours[4];           // the channels of red, green and blue that exist; then their number
    uint rules, most_in_pixel; // rules: a set of the following
};
static_assert(sizeof(Frame) == 104 && offsetof(Frame, first_x) == 48 && offsetof(Frame, colours) == 80 &&
              offsetof(Frame, rules) == 96);

inline constexpr uint averages = 1;          // Merge::average
inline constexpr uint focus_known = 2;       // so there is a CoC
inline constexpr uint focus_at_infinity = 4; // of the lens

} // namespace sparselens::warp_kernel
