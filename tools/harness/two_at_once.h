// Decides whether two frames fit into memory at the same time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace sparselens {

// Estimates a frame's memory from the size of its files, with the largest memory per byte that earlier frames took.
class TwoAtOnce {
public:
    // `bytes`: size of the files that each frame reads, 0 if unknown. `memory`: limit for both frames, in bytes.
    TwoAtOnce(std::vector<std::uint64_t> bytes, std::uint64_t memory)
        : bytes_(std::move(bytes)), memory_(double(memory)) {}

    // Whether frame i may run beside the frame before it. Call for each frame in order, before it begins; `peak` is the
    // largest memory use of the process so far, in bytes. The first two frames run alone, to measure what one takes.
    bool fit(std::size_t i, std::uint64_t peak) {
        if (i == 2) per_byte_ = double(peak) / of(0);
        if (i > 2) per_byte_ = std::max(per_byte_, double(peak) / most_at_once_);
        const double both = i > 0 ? of(i - 1) + of(i) : 0;
        const bool two = i >= 2 && per_byte_ * both <= memory_;
        most_at_once_ = std::max(most_at_once_, two ? both : of(i));
        return two;
    }

private:
    double of(std::size_t i) const { return double(std::max<std::uint64_t>(bytes_[i], 1)); }

    std::vector<std::uint64_t> bytes_;
    double memory_;
    double per_byte_ = 0, most_at_once_ = 0;
};

} // namespace sparselens
