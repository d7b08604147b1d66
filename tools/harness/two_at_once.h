// Whether two frames fit into memory at the same time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace sparselens {

// A frame takes memory as its files are large: as much for each of their bytes as frames before it took at most.
class TwoAtOnce {
public:
    // `bytes`: of the files that each frame reads; 0 where that is not known. `memory`: what all may take.
    TwoAtOnce(std::vector<std::uint64_t> bytes, std::uint64_t memory)
        : bytes_(std::move(bytes)), memory_(double(memory)) {}

    // Whether frame i may be worked on beside the one before it. Asked for each frame in turn, before it begins; `peak` is the most
    // memory that the process has held. The first two are worked on alone: then it is known what one takes.
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
