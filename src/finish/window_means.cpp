#include "finish/window_means.h"

#include "base/for_processors.h"
#include "base/parallel.h"

#include <array>
#include <vector>

namespace sparselens {

namespace {

// Rows or columns that are averaged side by side.
constexpr std::size_t lanes = 16;
using Lanes = std::array<float, lanes>;

// The mean of each entry and of one on each side of it.
FOR_PROCESSORS void mean_of_three(const std::vector<Lanes> &line, std::vector<Lanes> &result) {
    const std::size_t last = line.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
        const Lanes &before = line[i > 0 ? i - 1 : i], &behind = line[i < last ? i + 1 : i];
        const float first = i > 0 ? 1 : 0, third = i < last ? 1 : 0, share = 1 / (first + 1 + third);
        for (std::size_t k = 0; k < lanes; ++k)
            result[i][k] = share * (first * before[k] + line[i][k] + third * behind[k]);
    }
}

// The mean of each entry and of `radius` entries on each side of it. The sums are in double precision, because a lamp
// of radiance 1e4 that enters and leaves a running sum must leave no error behind.
FOR_PROCESSORS void mean_along(const std::vector<Lanes> &line, std::vector<Lanes> &result,
                               std::size_t radius) {
    const std::size_t length = line.size();
    std::array<double, lanes> sum{};
    std::size_t begin = 0, end = 0;
    for (std::size_t i = 0; i < length; ++i) {
        for (; end < length && end <= i + radius; ++end)
            for (std::size_t k = 0; k < lanes; ++k) sum[k] += double(line[end][k]);
        for (; begin + radius < i; ++begin)
            for (std::size_t k = 0; k < lanes; ++k) sum[k] -= double(line[begin][k]);
        const double share = 1 / double(end - begin);
        for (std::size_t k = 0; k < lanes; ++k) result[i][k] = float(sum[k] * share);
    }
}

// Entry i of lane k is values[i * along + k * across].
void means_of_lanes(float *values, std::size_t length, std::size_t along, std::size_t across,
                    std::size_t count, int radius, int passes) {
    std::vector<Lanes> line(length), scratch(length);
    for (std::size_t i = 0; i < length; ++i)
        for (std::size_t k = 0; k < count; ++k) line[i][k] = values[i * along + k * across];
    for (int pass = 0; pass < passes; ++pass) {
        if (radius == 1)
            mean_of_three(line, scratch);
        else
            mean_along(line, scratch, std::size_t(radius));
        line.swap(scratch);
    }
    for (std::size_t i = 0; i < length; ++i)
        for (std::size_t k = 0; k < count; ++k) values[i * along + k * across] = line[i][k];
}

void means(std::span<float> values, const Grid &grid, int radius, int passes) {
    const auto width = std::size_t(grid.width()), height = std::size_t(grid.height());
    parallel_ranges(height, lanes, [&](std::size_t begin, std::size_t end) {
        means_of_lanes(values.data() + begin * width, width, 1, width, end - begin, radius, passes);
    });
    parallel_ranges(width, lanes, [&](std::size_t begin, std::size_t end) {
        means_of_lanes(values.data() + begin, height, width, 1, end - begin, radius, passes);
    });
}

} // namespace

void box_mean(std::span<float> values, const Grid &grid, int radius) { means(values, grid, radius, 1); }

void soft_mean(std::span<float> values, const Grid &grid, int radius) { means(values, grid, radius, 3); }

} // namespace sparselens
