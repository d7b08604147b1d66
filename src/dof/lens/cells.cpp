#include "dof/lens/cells.h"

#include "base/numbers.h"
#include "dof/tuning.h"

#include <cstddef>

namespace sparselens {

namespace {

constexpr int size = lens_tile_size;
constexpr std::size_t pixels = std::size_t(size * size);
constexpr int beside = 2; // cells on either side of a pixel that it is interpolated from, at most

// The cells of a row or a column that a pixel is interpolated from, and their weights.
struct InterpolationWeights {
    std::size_t first, nearest; // cells of the tile
    std::array<float, 4> weight;
};

// Returns the weights of the means of four cells in the mean over [begin, end], in cells from the first cell's edge.
// They follow from the polynomial that has these four means, by its integral at the five edges.
std::array<float, 4> weights_of(double begin, double end) {
    const auto lagrange = [](int edge, double at) {
        double product = 1;
        for (int other = 0; other <= 4; ++other)
            if (other != edge) product *= (at - other) / (edge - other);
        return product;
    };
    std::array<double, 4> weight{};
    for (int edge = 1; edge <= 4; ++edge) {
        const double taken = (lagrange(edge, end) - lagrange(edge, begin)) / (end - begin);
        for (int cell = 0; cell < edge; ++cell) weight[std::size_t(cell)] += taken;
    }
    return {float(weight[0]), float(weight[1]), float(weight[2]), float(weight[3])};
}

std::array<InterpolationWeights, size> taps_of(int first_pixel, int first_cell, int across) {
    std::array<InterpolationWeights, size> taps;
    for (int n = 0; n < size; ++n) {
        // In cells from the middle of cell 0, times 2 across.
        const int twice = 2 * (first_pixel + n) + 1 - across;
        const int cell = floor_div(twice, 2 * across);
        const double middle = double(twice - cell * 2 * across) / (2 * across), half = 0.5 / across;
        const auto own = std::size_t(cell - first_cell);
        taps[std::size_t(n)] = {own - 1, own + (middle < 0.5 ? 0 : 1),
                                weights_of(1.5 + middle - half, 1.5 + middle + half)};
    }
    return taps;
}

Float4 least(Float4 a, Float4 b) { return a < b ? a : b; }
Float4 most(Float4 a, Float4 b) { return a > b ? a : b; }

// Returns the weighted sum of at(0) to at(3), in the given range.
template <typename At>
Float4 sum_of(const std::array<float, 4> &weight, CellRange range, const At &at) {
    const Float4 a = at(0), b = at(1), c = at(2), d = at(3);
    const Float4 sum = weight[0] * a + weight[1] * b + weight[2] * c + weight[3] * d;
    if (range == CellRange::open) return sum;
    return least(most(sum, least(least(a, b), least(c, d))), most(most(a, b), most(c, d)));
}

struct Interpolation {
    const TilePicture &cells;
    std::size_t count; // cells across and down
    std::array<InterpolationWeights, size> across, down;
    CellRange range;

    bool known(std::size_t column, std::size_t row) const { return cells.is_known(row * size + column); }
    Float4 value(std::size_t group, std::size_t column, std::size_t row) const {
        return load4(cells.values + group * cells.group_step + (row * size + column) * 4);
    }
    void interpolate(std::size_t group, float *to) const {
        std::vector<float> rows(count * size * 4); // [row of cells][column of pixels][4]
        for (std::size_t y = 0; y < count; ++y)
            for (std::size_t x = 0; x < size; ++x)
                store4(&rows[(y * size + x) * 4], sum_of(across[x].weight, range, [&](std::size_t n) {
                    return value(group, across[x].first + n, y);
                }));
        for (std::size_t y = 0; y < size; ++y)
            for (std::size_t x = 0; x < size; ++x)
                store4(to + (y * size + x) * 4, sum_of(down[y].weight, range, [&](std::size_t n) {
                           return load4(&rows[((down[y].first + n) * size + x) * 4]);
                       }));
    }
    bool all_known() const {
        for (std::size_t y = 0; y < count; ++y)
            for (std::size_t x = 0; x < count; ++x)
                if (!known(x, y)) return false;
        return true;
    }
    bool all_known_for(std::size_t x, std::size_t y) const {
        for (std::size_t v = 0; v < 4; ++v)
            for (std::size_t u = 0; u < 4; ++u)
                if (!known(across[x].first + u, down[y].first + v)) return false;
        return true;
    }
};

// Gives pixels of which some cells are unknown the value of the cell that they lie in.
void take_nearest(const Interpolation &from, PixelsOfCells &made) {
    for (std::size_t y = 0; y < size; ++y)
        for (std::size_t x = 0; x < size; ++x) {
            if (from.all_known_for(x, y)) continue;
            const std::size_t column = from.across[x].nearest, row = from.down[y].nearest;
            for (std::size_t g = 0; g < made.groups; ++g) {
                const std::size_t pixel = g * pixels + y * size + x;
                store4(&made.values[pixel * 4], from.value(g, column, row));
                made.known[pixel] = from.known(column, row);
            }
        }
}

} // namespace

int cell_size_for(float least_coc, Quality quality) {
    const float least_cells =
        quality == Quality::final ? GatherTuning::final_cells : GatherTuning::normal_cells;
    for (const int across : cell_sizes)
        if (least_coc >= least_cells * float(across)) return across;
    return 1;
}

int TileCells::count() const { return size / across + 2 * beside; }

TileCells cells_of_tile(const Imath::V2i &first_pixel, int across) {
    const auto first = [&](int pixel) { return floor_div(2 * pixel + 1 - across, 2 * across) - 1; };
    return {across, first_pixel, {first(first_pixel.x), first(first_pixel.y)}};
}

TilePicture PixelsOfCells::picture() const { return {values.data(), known.data(), groups, pixels * 4}; }

PixelsOfCells interpolated(const TilePicture &cells, const TileCells &of, CellRange range) {
    const Interpolation from{cells, std::size_t(of.count()), taps_of(of.first_pixel.x, of.first.x, of.across),
                             taps_of(of.first_pixel.y, of.first.y, of.across), range};
    PixelsOfCells made{std::vector<float>(cells.groups * pixels * 4),
                       std::vector<float>(cells.groups * pixels, 1.0f), cells.groups};
    for (std::size_t g = 0; g < cells.groups; ++g) from.interpolate(g, &made.values[g * pixels * 4]);
    if (!from.all_known()) take_nearest(from, made);
    return made;
}

} // namespace sparselens
