// The planes that dof-finish works on, and their parts: windows around each pixel, cells of pixels, and classes of
// values.
#pragma once

#include "base/grid.h"
#include "base/image.h"
#include "finish/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace sparselens {

using Values = LargeArray<float>;      // one value per pixel
using Colours = std::vector<Values>;   // one to three channels
using Halves = std::array<Colours, 2>; // the same for two independent renders

// How many samples the pixels of two independent renders have, > 0.
struct RayCounts {
    RayCounts(const std::array<double, 2> &means = {1, 1}, std::array<Values, 2> of_pixels = {})
        : mean(means), by_pixel(std::move(of_pixels)) {}

    std::array<double, 2> mean;
    std::array<Values, 2> by_pixel; // empty: the same everywhere

    std::array<float, 2> at(std::size_t i) const {
        if (by_pixel[0].empty()) return {float(mean[0]), float(mean[1])};
        return {by_pixel[0][i], by_pixel[1][i]};
    }
};

// max(v, 0), exactly, without a branch, so that compilers can process several values at once.
inline float positive(float v) { return (v + std::abs(v)) / 2; }

// By how much a picture is brightened before a tone curve judges it: the root mean square of its lit pixels becomes 1. No
// pixel counts for more than 16 times the mean, so that a lamp hardly darkens the rest. Twice the light gives half.
float exposure_of(const Colours &picture);

// How visible a change is in a value as bright as `v`, exposed: the squared slope of the tone curve v / (1 + v).
inline float seen(float v) {
    const float reciprocal = 1 / (1 + positive(v));
    return reciprocal * reciprocal * reciprocal * reciprocal;
}

// The brightness of a pixel: the mean of its channels, at least 0.
inline float brightness(const Colours &colours, std::size_t i) {
    float sum = 0;
    for (const Values &channel : colours) sum += channel[i];
    return std::max(sum / float(colours.size()), 0.0f);
}

// Means over windows around each pixel of a plane. Only the part of a window inside the picture counts, so a constant
// plane stays constant.

// The mean over a square of side 2 radius + 1, in place. `values` holds a value for each pixel of `grid`; radius >= 0.
void box_mean(std::span<float> values, const ArrayGrid &grid, int radius);

// Three box means in succession, in place: nearly a Gaussian of standard deviation sqrt(radius (radius + 1)), by the
// central limit theorem.
void soft_mean(std::span<float> values, const ArrayGrid &grid, int radius);

// Square cells of pixels. Sums over windows of many pixels change little from one pixel to the next, so they are
// computed for cells and interpolated between the middles of cells.

// Pixels of a row that are processed at once; entries beyond its end are 0.
constexpr std::size_t run_length = 64;
using Run = std::array<float, run_length>;

class Cells {
public:
    // `side`: 1, 2, 4 or 8 pixels. Cells at the right and lower border may be smaller.
    Cells(const ArrayGrid &pixels, int side);

    const ArrayGrid &pixels() const { return pixels_; }
    const ArrayGrid &grid() const { return grid_; } // of the cells
    std::size_t side() const { return side_; }
    std::size_t row_of(std::size_t y) const { return y / side_; }
    // The pixel rows of a row of cells: the first, and the one after the last.
    std::array<std::size_t, 2> rows(std::size_t row) const;

    // Adds a run that begins at column x to a row of sums.
    void add(const Run &run, std::size_t x, std::span<float> sums) const;
    // Divides a row of sums, which gives the means over the pixels of each cell.
    void divide(std::size_t row, std::span<float> sums) const;
    // One row of a plane of cells.
    std::span<float> of_row(Values &plane, std::size_t row) const;

    // Sets the pixels of row y, interpolated between the middles of cells, and some entries beyond its end.
    void interpolate(const Values &plane, std::size_t y, std::vector<float> &pixels) const;

private:
    ArrayGrid pixels_, grid_;
    std::size_t side_;
};

// Classes of equal weight along a measure, and the continuous place of a value in them.
class Classes {
public:
    // For values in [least, most]; other values count as the nearer limit.
    Classes(std::size_t count, float least, float most);

    // Each pixel counts half by its weight and half equally, so that neither many pixels of little weight nor a few of
    // great weight make up all classes.
    void add(float value, double weight);
    void divide(); // after the last add()

    std::size_t of(float value) const; // [0, count)
    float place_of(float value) const; // the same, continuous: k + 1/2 in the middle of class k

private:
    float bin_of(float value) const; // continuous

    std::size_t count_;
    float least_, most_;
    std::vector<std::array<double, 2>> bins_; // pixels, weights
    std::vector<float> places_;               // of the beginnings of bins, and of the last end
};

} // namespace sparselens
