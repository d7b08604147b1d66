#include "dof/lens/tile_projection.h"

#include "base/parallel.h"
#include "kernels/lens_rules.h"

#include <algorithm>
#include <cstddef>

namespace sparselens {

namespace {

constexpr float rounding = 1.0f / 64; // pixels: more than any position is off

// Along one axis: clears the entries of blocks that the lens point cannot move into [from, to), given that their
// samples lie between `least` and `most`, and their CoCs between those two. An entry stays where an infinite CoC times
// 0 says nothing.
FOR_PROCESSORS
void find_reached(const float *least, const float *most, const float *coc_of_least, const float *coc_of_most,
                  std::size_t count, float lens, float from, float to, std::int32_t *in_reach) {
    for (std::size_t i = 0; i < count; ++i)
        in_reach[i] &= !(most[i] + coc_of_most[i] * lens < from) & !(least[i] + coc_of_least[i] * lens >= to);
}

} // namespace

TileProjection::TileProjection(const LensSample &lens, float corner_x, float corner_y, int row)
    : lens_x(lens.x), lens_y(lens.y), tile_x(corner_x), tile_y(corner_y),
      shift_x(lens.pixel_x + kernels::shift_of_samples), shift_y(lens.pixel_y + kernels::shift_of_samples),
      stride(row) {}

// This loop is most of the gather's work.
FOR_PROCESSORS
void project_to_cells(const TileProjection &p, const float *x, const float *y, const float *coc,
                      std::uint32_t count, std::int32_t *cells) {
    const int stride = p.stride; // local copies rule out aliasing
    const float limit = float(stride - 1);
    for (std::uint32_t i = 0; i < count; ++i) {
        const float cx = kernels::seen_along(x[i], p.tile_x, coc[i], p.lens_x, p.shift_x);
        const float cy = kernels::seen_along(y[i], p.tile_y, coc[i], p.lens_y, p.shift_y);
        const float column = kernels::cell_along(cx, limit), row = kernels::cell_along(cy, limit);
        cells[i] = std::int32_t(row) * stride + std::int32_t(column);
    }
}

void BlockBounds::set(std::span<const std::uint32_t> blocks, const BlockedSamples &samples) {
    blocks_ = blocks;
    for (auto *array : {&x_min_, &x_max_, &y_min_, &y_max_, &coc_min_, &coc_max_})
        array->resize(blocks.size());
    in_reach_.resize(blocks.size());
    reached_.resize(blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const SampleBlock &block = samples.blocks[blocks[i]];
        x_min_[i] = block.x_min;
        x_max_[i] = block.x_max;
        y_min_[i] = block.y_min;
        y_max_[i] = block.y_max;
        coc_min_[i] = block.coc_min;
        coc_max_[i] = block.coc_max;
    }
}

std::span<const std::uint32_t> BlockBounds::reached(const LensSample &lens, const Box &box) {
    std::ranges::fill(in_reach_, 1);
    const auto along = [&](const std::vector<float> &least, const std::vector<float> &most, float by,
                           float from, float to) {
        const bool same = by >= 0; // else the sample with the largest CoC moves farthest down
        find_reached(least.data(), most.data(), (same ? coc_min_ : coc_max_).data(),
                     (same ? coc_max_ : coc_min_).data(), blocks_.size(), by, from - rounding, to + rounding,
                     in_reach_.data());
    };
    along(x_min_, x_max_, lens.x, box.left - lens.pixel_x, box.right - lens.pixel_x);
    along(y_min_, y_max_, lens.y, box.top - lens.pixel_y, box.bottom - lens.pixel_y);
    std::size_t count = 0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        reached_[count] = blocks_[i];
        count += std::size_t(in_reach_[i]);
    }
    return std::span(reached_).first(count);
}

} // namespace sparselens
