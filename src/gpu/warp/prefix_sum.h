// The prefix sum of numbers in a buffer of a device: each becomes the sum of those before it.
#pragma once

#include "gpu/device.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace sparselens::gpu {

// The work groups for a number of items; more than one row if they are many.
std::array<std::uint32_t, 3> groups_for(std::size_t items, std::size_t per_group);

class PrefixSum {
public:
    explicit PrefixSum(Device &device);

    // The numbers are 32 bits each, and so is their sum.
    void run(Buffer &numbers, std::size_t count);

private:
    Device &device_;
    Program within_, add_; // within blocks; and adding to each block the sum of those before it
};

} // namespace sparselens::gpu
