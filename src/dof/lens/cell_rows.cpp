#include "dof/lens/cell_rows.h"

#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace sparselens {

using tile_cells::at, tile_cells::border, tile_cells::size, tile_cells::stride;

namespace {

using Float8 [[gnu::vector_size(32)]] = float;

// 16 bits at each step, so that a vector holds as many numbers as it can.
[[gnu::always_inline]] inline std::int16_t pixel_along(std::int16_t at, std::int16_t coc, std::int16_t lens,
                                                       std::int16_t shift, const WholeLens &by) {
    const auto moved = std::int16_t(kernels::moved(coc, lens));
    const auto seen = std::int16_t(at + moved + shift);
    const std::int16_t from_first = seen < by.first ? by.first : seen;
    const std::int16_t within = from_first < by.last ? from_first : by.last;
    return std::int16_t(within * by.to_pixel >> 16);
}

constexpr int half = 32;
constexpr std::array<std::uint32_t, half> one_bit = [] {
    std::array<std::uint32_t, half> bits{};
    for (std::size_t n = 0; n < half; ++n) bits[n] = std::uint32_t{1} << n;
    return bits;
}();

// Without a branch.
std::uint32_t bit_if(bool is_set, std::size_t n) { return (0 - std::uint32_t(is_set)) & one_bit[n]; }

[[gnu::always_inline]] inline std::uint32_t zeros_of_half(const CellWord *words) {
    std::uint32_t zeros = 0;
    for (std::size_t n = 0; n < half; ++n) zeros |= bit_if(words[n] == 0, n);
    return zeros;
}

[[gnu::always_inline]] inline std::uint32_t far_behind_of_half(const CellWord *words, CellWord number_mask,
                                                               CellWord step) {
    std::uint32_t far = 0;
    for (std::ptrdiff_t n = 0; n < std::ptrdiff_t(half); ++n) {
        const CellWord *word = words + n;
        const CellWord sides = std::max(std::min(word[-1], word[1]), std::min(word[-stride], word[stride])),
                       corners = std::max(std::min(word[-stride - 1], word[stride + 1]),
                                          std::min(word[-stride + 1], word[stride - 1]));
        far |= bit_if(std::max(sides, corners) > (word[0] | number_mask) + step, std::size_t(n));
    }
    return far;
}

} // namespace

FOR_PROCESSORS
void whole_places(const kernels::TileUnits &units, float middle, const float *at, std::size_t count,
                  std::int16_t *to) {
    const float unit = units.unit, farthest = units.farthest; // local copies rule out aliasing
    for (std::size_t i = 0; i < count; ++i)
        to[i] = std::int16_t(kernels::whole_place(at[i], middle, unit, farthest));
}

FOR_PROCESSORS
void whole_cocs(const kernels::TileUnits &units, const float *coc, std::size_t count, std::int16_t *to) {
    const float unit = units.unit * units.lens_unit, most = units.unit * units.farthest;
    for (std::size_t i = 0; i < count; ++i) to[i] = std::int16_t(kernels::whole_coc(coc[i], unit, most));
}

// This loop is most of the gather's work.
FOR_PROCESSORS
void project_to_cells(const WholeLens &lens, const std::int16_t *x, const std::int16_t *y,
                      const std::int16_t *coc, std::uint32_t count, std::uint16_t *cells) {
    const WholeLens by = lens; // local copies rule out aliasing
    constexpr int middle = int(at(size / 2, size / 2));
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::int16_t column = pixel_along(x[i], coc[i], by.x, by.shift_x, by),
                           row = pixel_along(y[i], coc[i], by.y, by.shift_y, by);
        cells[i] = std::uint16_t(row * stride + column + middle);
    }
}

FOR_PROCESSORS
void find_reached(const float *least, const float *most, const float *coc_of_least, const float *coc_of_most,
                  std::size_t count, float lens, float from, float to, std::int32_t *in_reach) {
    for (std::size_t i = 0; i < count; ++i)
        in_reach[i] &= !(most[i] + coc_of_most[i] * lens < from) & !(least[i] + coc_of_least[i] * lens >= to);
}

FOR_PROCESSORS std::uint64_t zeros_of(const CellWord *words) {
    return std::uint64_t{zeros_of_half(words + half)} << half | zeros_of_half(words);
}

FOR_PROCESSORS std::uint64_t far_behind(const CellWord *words, CellWord number_mask, CellWord step) {
    return std::uint64_t{far_behind_of_half(words + half, number_mask, step)} << half |
           far_behind_of_half(words, number_mask, step);
}

FOR_PROCESSORS
void add_rows(float *sums, const std::array<const CellWord *, points_at_once> &rows,
              const std::array<Float4, points_at_once> &factors, const float *colours, CellWord number_mask,
              int count) {
    const auto join = [](Float4 a, Float4 b, Float8 &to) {
        to = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    };
    Float8 factor[points_at_once], sum, light;
    for (std::size_t l = 0; l < rows.size(); ++l) join(factors[l], factors[l], factor[l]);
    for (int x = 0; x < count; x += 2, sums += 8) {
        join(load4(sums), load4(sums + 4), sum);
        for (std::size_t l = 0; l < rows.size(); ++l) {
            const CellWord *words = rows[l] + x;
            join(load4(colours + std::size_t(words[0] & number_mask) * 4),
                 load4(colours + std::size_t(words[1] & number_mask) * 4), light);
            sum += factor[l] * light;
        }
        std::memcpy(sums, &sum, sizeof(sum));
    }
}

} // namespace sparselens
