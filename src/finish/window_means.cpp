#include "finish/window_means.h"

#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <vector>

namespace sparselens {

float exposure_of(const Colours &picture) {
    const auto mean_of_lit = [&](const auto &of) {
        double sum = 0, lit = 0;
        for (std::size_t i = 0; i < picture[0].size(); ++i) {
            const double light = double(brightness(picture, i));
            sum += of(light);
            lit += light > 0;
        }
        return sum / std::max(lit, 1.0);
    };
    const double most = FinishTuning::most_over_mean * mean_of_lit([](double light) { return light; });
    const double square =
        mean_of_lit([&](double light) { return std::min(light, most) * std::min(light, most); });
    return square > 1e-30 ? float(1 / std::sqrt(square)) : 1;
}

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

void means(std::span<float> values, const ArrayGrid &grid, int radius, int passes) {
    const auto width = std::size_t(grid.width()), height = std::size_t(grid.height());
    parallel_ranges(height, lanes, [&](std::size_t begin, std::size_t end) {
        means_of_lanes(values.data() + begin * width, width, 1, width, end - begin, radius, passes);
    });
    parallel_ranges(width, lanes, [&](std::size_t begin, std::size_t end) {
        means_of_lanes(values.data() + begin, height, width, 1, end - begin, radius, passes);
    });
}

} // namespace

void box_mean(std::span<float> values, const ArrayGrid &grid, int radius) { means(values, grid, radius, 1); }

void soft_mean(std::span<float> values, const ArrayGrid &grid, int radius) { means(values, grid, radius, 3); }

namespace {

// How far the middle of pixel `at` of a cell lies beyond the cell's middle, in cells.
float beyond_middle(std::size_t at, std::size_t side) { return (float(at) + 0.5f) / float(side) - 0.5f; }

template <std::size_t side>
void add_cells(const float *__restrict run, float *__restrict sums, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < side; ++j) sums[i] += run[i * side + j];
}

FOR_PROCESSORS void mix(const float *__restrict first, const float *__restrict second, float share,
                        float *__restrict mixed, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) mixed[i] = first[i] + share * (second[i] - first[i]);
}

} // namespace

Cells::Cells(const ArrayGrid &pixels, int side)
    : pixels_(pixels), grid_(pieces_of(pixels.width(), side), pieces_of(pixels.height(), side)),
      side_(std::size_t(side)) {
    assert(side_ == 1 || side_ == 2 || side_ == 4 || side_ == 8);
}

std::array<std::size_t, 2> Cells::rows(std::size_t row) const {
    return {row * side_, std::min((row + 1) * side_, std::size_t(pixels_.height()))};
}

void Cells::add(const Run &run, std::size_t x, std::span<float> sums) const {
    const std::size_t first = x / side_, count = std::min(run_length / side_, sums.size() - first);
    constexpr std::array by_logarithm{add_cells<1>, add_cells<2>, add_cells<4>, add_cells<8>};
    by_logarithm[std::size_t(std::countr_zero(side_))](run.data(), sums.data() + first, count);
}

void Cells::divide(std::size_t row, std::span<float> sums) const {
    const auto [begin, end] = rows(row);
    const std::size_t last = sums.size() - 1, width = std::size_t(pixels_.width()) - last * side_;
    const float share = 1 / float((end - begin) * side_);
    for (std::size_t i = 0; i < last; ++i) sums[i] *= share;
    sums[last] /= float((end - begin) * width);
}

std::span<float> Cells::of_row(Values &plane, std::size_t row) const {
    const auto width = std::size_t(grid_.width());
    return std::span(plane).subspan(row * width, width);
}

void Cells::interpolate(const Values &plane, std::size_t y, std::vector<float> &pixels) const {
    const auto width = std::size_t(grid_.width()), last = std::size_t(grid_.height()) - 1;
    const std::size_t row = row_of(y);
    const float down = beyond_middle(y % side_, side_);
    const std::size_t other = down < 0 ? row - std::size_t(row > 0) : std::min(row + 1, last);
    std::vector<float> line(width + 2); // with a copy of each end
    mix(plane.data() + row * width, plane.data() + other * width, std::abs(down), line.data() + 1, width);
    line.front() = line[1];
    line.back() = line[width];
    pixels.resize(width * side_);
    for (std::size_t j = 0; j < side_; ++j) {
        const float across = beyond_middle(j, side_);
        const float *here = line.data() + 1, *beside = across < 0 ? here - 1 : here + 1;
        for (std::size_t i = 0; i < width; ++i)
            pixels[i * side_ + j] = here[i] + std::abs(across) * (beside[i] - here[i]);
    }
}

namespace {

constexpr std::size_t bins = 4096;

} // namespace

Classes::Classes(std::size_t count, float least, float most)
    : count_(count), least_(least), most_(most), bins_(bins, {0, 0}) {}

float Classes::bin_of(float value) const {
    return (std::clamp(value, least_, most_) - least_) / (most_ - least_) * float(bins);
}

void Classes::add(float value, double weight) {
    std::array<double, 2> &bin = bins_[std::min(std::size_t(bin_of(value)), bins - 1)];
    bin[0] += 1;
    bin[1] += weight;
}

void Classes::divide() {
    std::array<double, 2> all{0, 0};
    for (const auto &bin : bins_)
        for (std::size_t k = 0; k < 2; ++k) all[k] += bin[k];
    std::vector<std::size_t> edges(1, 0);
    double passed = 0;
    for (std::size_t i = 0; i < bins && edges.size() < count_; ++i) {
        passed += bins_[i][0] / std::max(all[0], 1e-300) + bins_[i][1] / std::max(all[1], 1e-300);
        while (edges.size() < count_ && passed >= 2 * double(edges.size()) / double(count_))
            edges.push_back(i + 1);
    }
    edges.resize(count_, bins);
    edges.push_back(bins);
    places_.assign(bins + 1, float(count_));
    for (std::size_t k = 0; k < count_; ++k)
        for (std::size_t i = edges[k]; i < edges[k + 1]; ++i)
            places_[i] = float(k) + float(i - edges[k]) / float(edges[k + 1] - edges[k]);
}

std::size_t Classes::of(float value) const { return std::min(std::size_t(place_of(value)), count_ - 1); }

float Classes::place_of(float value) const {
    const float bin = bin_of(value);
    const std::size_t i = std::min(std::size_t(bin), bins - 1);
    return places_[i] + (bin - float(i)) * (places_[i + 1] - places_[i]);
}

} // namespace sparselens
