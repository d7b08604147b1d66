// The kernels of the warp, and their work on one stripe: views are uploaded, samples of the LDI are downloaded.
#pragma once

#include "gpu/device.h"
#include "gpu/warp/warp_stripe.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sparselens::gpu {

// The work groups for a number of items; more than one row if they are many.
std::array<std::uint32_t, 3> groups_for(std::size_t items, std::size_t per_group);

// The prefix sum of numbers in a buffer of a device: each becomes the sum of those before it.
class PrefixSum {
public:
    explicit PrefixSum(Device &device);

    // The numbers are 32 bits each, and so is their sum.
    void run(Buffer &numbers, std::size_t count);

private:
    Device &device_;
    Program within_, add_; // within blocks; and adding to each block the sum of those before it
};

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
