// Rows of the centre view that are worked on at once, with the data that they need of each view, laid out as
// warp_data.glsl reads it. A picture whose samples fit into no buffer of the device is warped stripe by stripe.
#pragma once

#include "kernels/warp_layout.h"
#include "warp/warp_device.h"

#include <Imath/ImathBox.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sparselens::gpu {

struct WarpStripe {
    // The rows of a view that are needed.
    struct Slice {
        std::size_t first_row, end_row; // counted from the top
        std::uint64_t samples;
    };

    Imath::Box2i box; // of the result
    std::vector<Slice> slices;
    std::vector<warp_kernel::View> views;
    std::size_t samples = 0, begins = 0; // of all slices
};

// The largest 1 / z of all samples; infinity if single precision on a device may not hold it.
double largest_inverse_z(const ReprojectedViews &views);

// `inverse_z`: largest_inverse_z().
WarpStripe make_stripe(const WarpScene &scene, const Imath::Box2i &box, double inverse_z);

// The size of the largest buffer that the stripe takes, bytes.
std::size_t buffer_bytes(const WarpScene &scene, const WarpStripe &stripe);

warp_kernel::Frame frame_of(const WarpScene &scene, const WarpStripe &stripe, std::uint32_t most_in_pixel);

} // namespace sparselens::gpu
