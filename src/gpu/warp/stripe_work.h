// The kernels of the warp, and their work on one stripe: views are uploaded, samples of the LDI are downloaded.
#pragma once

#include "gpu/device.h"
#include "gpu/warp/prefix_sum.h"
#include "gpu/warp/warp_stripe.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sparselens::gpu {

struct WarpKernels {
    explicit WarpKernels(Device &device);

    Program land, surfaces, differences, vote, emit;
    PrefixSum sum;
};

class StripeWork {
public:
    // Uploads what the stripe needs.
    StripeWork(Device &device, WarpKernels &kernels, const WarpScene &scene, const WarpStripe &stripe,
               std::uint32_t most_in_pixel);

    // Puts all samples into the pixels that they fall into. Returns false if some pixel has too many samples; nothing
    // else can be done then.
    bool land();
    Ldi merge();                                       // once, after land()
    std::vector<Disagreement> differing_blocks();      // after merge(); see WarpedBands
    std::size_t uploaded() const { return uploaded_; } // bytes

private:
    enum Binding : std::size_t; // as in warp_data.glsl

    void upload_views();
    void upload(std::size_t binding, std::span<const std::byte> bytes);
    void make(std::size_t binding, std::size_t bytes);
    std::uint32_t word(std::size_t binding, std::size_t index); // 32 bits of a buffer
    void run(const Program &program, std::span<const std::byte> push,
             const std::array<std::uint32_t, 3> &groups);
    Ldi download(std::size_t samples);

    Device &device_;
    WarpKernels &kernels_;
    const WarpScene &scene_;
    const WarpStripe &stripe_;
    std::size_t pixels_, blocks_, uploaded_ = 0;
    std::array<std::optional<Buffer>, 15> buffers_;
};

} // namespace sparselens::gpu
