// Replaces each number in a buffer by the sum of those before it (prefix_sums.comp), as std::exclusive_scan() does.
#pragma once

#include "gpu/device.h"

#include <cstddef>
#include <vector>

namespace sparselens::gpu {

class PrefixSums {
public:
    explicit PrefixSums(Device &device);

    // Records it for the first `count` numbers, of 32 bits; at most 2^28.
    void run(const Buffer &numbers, std::size_t count);

private:
    Device &device_;
    Program program_;
    std::vector<Buffer> totals_; // of chunks
};

} // namespace sparselens::gpu
