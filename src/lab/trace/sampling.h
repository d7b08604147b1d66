// Sample points for ray tracing: a Sobol sequence with its own Owen scrambling in every pixel. Points of one
// pixel fill the unit cube evenly, those of different pixels have nothing to do with each other.
//
// Neither class holds state: any part of any pixel's points can be asked for, in any order, from any thread.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens::lab {

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

// The samples of a picture: where in its pixel each one lies, where on the lens, where on the light. Three pairs
// of coordinates of one Sobol point, all in the unit square.
class PixelSamples {
public:
    // regular, and count = n * n: positions in the pixel are an n x n grid, the same in every pixel.
    // `stream` tells pictures apart, so that their noise is independent.
    PixelSamples(int count, bool regular, std::uint32_t stream);

    int count() const { return int(points_.count()); }

    // Of samples [first, first + out.size()) of pixel (x, y).
    void in_pixel(int x, int y, std::uint32_t first, std::span<Imath::V2d> out) const;
    void on_lens(int x, int y, std::uint32_t first, std::span<Imath::V2d> out) const;
    void on_light(int x, int y, std::uint32_t first, std::span<Imath::V2d> out) const;

private:
    void pairs(std::size_t dimension, int x, int y, std::uint32_t first, std::span<Imath::V2d> out) const;

    SobolPoints points_;
    std::vector<Imath::V2d> grid_; // empty: not regular
    std::uint32_t stream_;
};

} // namespace sparselens::lab
