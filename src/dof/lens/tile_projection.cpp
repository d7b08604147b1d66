#include "dof/lens/tile_projection.h"

#include "dof/lens/cell_rows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sparselens {

using tile_cells::border, tile_cells::size;

kernels::TileUnits tile_units(float largest_coc, std::span<const LensSample> lens) {
    float reach = 0, shift = 0;
    for (const LensSample &p : lens) {
        reach = std::max({reach, std::abs(p.x), std::abs(p.y)});
        shift = std::max({shift, std::abs(p.pixel_x), std::abs(p.pixel_y)});
    }
    kernels::TileUnits units{128, 1, 0, largest_coc, 0, 0, 0};
    while (units.lens_unit < reach * 0.999f) units.lens_unit *= 2;
    while (reach > 0 && units.lens_unit / 2 >= reach * 0.999f) units.lens_unit /= 2;
    const auto all = [&] { return (2 * units.farthest + shift + kernels::around_tile_px) * units.unit; };
    constexpr float most = 32767, least_unit = 4;
    units.farthest = std::min(largest_coc * units.lens_unit + shift, (most / least_unit - shift) / 2 - 20);
    while (all() > most) units.unit /= 2;
    return units;
}

void WholePlaces::add(const kernels::TileUnits &units, const Imath::V2f &middle, const float *from_x,
                      const float *from_y, const float *from_coc, std::uint32_t samples) {
    const std::size_t first = x.size(), end = first + samples,
                      padded = first + (samples + lanes - 1) / lanes * lanes;
    for (auto *places : {&x, &y, &coc}) places->resize(padded);
    whole_places(units, middle.x, from_x, samples, x.data() + first);
    whole_places(units, middle.y, from_y, samples, y.data() + first);
    whole_cocs(units, from_coc, samples, coc.data() + first);
    const auto leave_out = [&](std::size_t i) {
        x[i] = y[i] = -32767;
        coc[i] = 0;
    };
    for (std::size_t i = end; i < padded; ++i) leave_out(i);
    for (std::size_t i = 0; i < samples; ++i)
        if (std::abs(from_coc[i]) > units.widest) leave_out(first + i);
}

WholeLens::WholeLens(const kernels::TileUnits &units, const LensSample &lens)
    : x(std::int16_t(kernels::whole_lens(lens.x, units.lens_unit))),
      y(std::int16_t(kernels::whole_lens(lens.y, units.lens_unit))),
      shift_x(std::int16_t(kernels::whole_shift(lens.pixel_x, units.unit, units.farthest))),
      shift_y(std::int16_t(kernels::whole_shift(lens.pixel_y, units.unit, units.farthest))),
      first(std::int16_t(-(size / 2 + border) * int(units.unit))),
      last(std::int16_t((size / 2 + border) * int(units.unit) - 1)),
      to_pixel(std::int16_t(65536 / units.unit)) {}

void BlockBounds::set(std::span<const std::uint32_t> blocks, const BlockedSamples &samples,
                      const kernels::TileUnits &units) {
    rounding_ = 3 / units.unit;
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
                     (same ? coc_max_ : coc_min_).data(), in_reach_.size(), by, from - rounding_,
                     to + rounding_, in_reach_.data());
    };
    along(x_min_, x_max_, lens.x, box.left - lens.pixel_x, box.right - lens.pixel_x);
    along(y_min_, y_max_, lens.y, box.top - lens.pixel_y, box.bottom - lens.pixel_y);
    std::size_t count = 0;
    for (std::size_t i = 0; i < in_reach_.size(); ++i) {
        reached_[count] = std::uint32_t(i);
        count += std::size_t(in_reach_[i]);
    }
    return std::span(reached_).first(count);
}

} // namespace sparselens
