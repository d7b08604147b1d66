// Sample points for ray tracing: a Sobol sequence with separate Owen scrambling in every pixel. The points of one pixel
// fill the unit cube evenly; those of different pixels are independent.
//
// Neither class has state: any part of the points of any pixel can be computed, in any order, on any thread.
#pragma once

#include "lab/trace/motion.h"

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens::lab {

class SobolPoints {
public:
    static constexpr std::size_t dimensions = 7;
    explicit SobolPoints(std::uint32_t count);

    std::uint32_t count() const { return count_; }

    // Coordinate `dimension` of points [first, first + out.size()), scrambled by `seed`: in [0, 1).
    void coordinates(std::size_t dimension, std::uint32_t seed, std::uint32_t first,
                     std::span<double> out) const;

private:
    std::uint32_t count_;
    std::array<std::vector<std::uint32_t>, dimensions> reversed_; // lowest bit first
};

// The samples of a picture: the position of each sample in its pixel, on the lens and on the light, and its time. They
// are coordinates of one Sobol point: three pairs, all in the unit square, and one. So each part of the shutter's time
// has points all over the lens.
class PixelSamples {
public:
    // If `regular` and count = n * n, the positions in the pixel are an n x n grid, the same in every pixel.
    // `stream` distinguishes pictures, so that their noise is independent.
    PixelSamples(int count, bool regular, std::uint32_t stream);

    int count() const { return int(points_.count()); }

    // The positions of samples [first, first + out.size()) in pixel (x, y).
    void in_pixel(int x, int y, std::uint32_t first, std::span<Imath::V2d> out) const;
    void on_lens(int x, int y, std::uint32_t first, std::span<Imath::V2d> out) const;
    void on_light(int x, int y, std::uint32_t first, std::span<Imath::V2d> out) const;

    // The times of these samples, spread evenly over the exposure.
    void in_time(const Exposure &exposure, int x, int y, std::uint32_t first, std::span<double> out) const;

private:
    std::uint32_t seed_of(int x, int y, std::size_t dimension) const;
    void pairs(std::size_t dimension, int x, int y, std::uint32_t first, std::span<Imath::V2d> out) const;

    SobolPoints points_;
    std::vector<Imath::V2d> grid_; // empty if not `regular`
    std::uint32_t stream_;
};

} // namespace sparselens::lab
