// Sample points for ray tracing: a Sobol sequence with its own Owen scrambling in every pixel. Points of one
// pixel fill the unit cube evenly, those of different pixels have nothing to do with each other.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens {

class SobolPoints {
public:
    static constexpr std::size_t dimensions = 6;
    explicit SobolPoints(std::uint32_t count);

    std::uint32_t count() const { return count_; }

    // Coordinate `dimension` of points [first, first + out.size()), scrambled by `seed`: in [0, 1).
    void coordinates(std::size_t dimension, std::uint32_t seed, std::uint32_t first,
                     std::span<double> out) const;

private:
    std::uint32_t count_;
    std::array<std::vector<std::uint32_t>, dimensions> reversed_; // lowest bit first
};

} // namespace sparselens
