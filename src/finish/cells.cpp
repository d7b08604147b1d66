#include "finish/cells.h"

#include "base/for_processors.h"

#include <bit>
#include <cassert>

namespace sparselens {

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

Cells::Cells(const Grid &pixels, int side)
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

} // namespace sparselens
