#include "dof/selective/splat_blocks.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sparselens {

namespace {

constexpr int block_size = 16; // pixels

struct Blocks {
    int width, height, across;

    explicit Blocks(const Windows &windows)
        : width(windows.width()), height(windows.height()), across((width + block_size - 1) / block_size) {}

    std::size_t count() const {
        return std::size_t(across) * std::size_t((height + block_size - 1) / block_size);
    }

    template <typename Visit>
    void for_each_pixel(std::size_t block, const Visit &visit) const {
        const int left = int(block) % across * block_size, top = int(block) / across * block_size;
        for (int y = top; y < std::min(top + block_size, height); ++y)
            for (int x = left; x < std::min(left + block_size, width); ++x)
                visit(std::size_t(y) * std::size_t(width) + std::size_t(x));
    }
};

// The splats of a block front to back; equal bins stay in pixel order.
std::vector<Splat> splats_of_block(const SplatSource &source, const Blocks &blocks, std::size_t block) {
    std::vector<Splat> splats;
    blocks.for_each_pixel(block, [&](std::size_t pixel) {
        source.for_each(pixel, [&](const Splat &splat) { splats.push_back(splat); });
    });
    std::stable_sort(splats.begin(), splats.end(),
                     [](const auto &a, const auto &b) { return a.bin < b.bin; });
    return splats;
}

void put_values(CellGrid &grid, std::size_t at, const Splat &splat, const SplatSource &source) {
    float *value = &grid.values[at * grid.size()];
    *value++ = float(splat.coverage);
    *value++ = float(splat.known);
    for (const std::size_t channel : source.colours()) *value++ = float(source.colour(splat, channel));
    *value = float(splat.known * std::abs(splat.coc));
}

void extend(Cell &cell, const Splat &splat, double pixel_aspect) {
    const double radius = std::abs(splat.coc);
    const Imath::V2d extent(radius, radius * pixel_aspect);
    cell.centres.extendBy(splat.position);
    cell.reach.extendBy(splat.position - extent);
    cell.reach.extendBy(splat.position + extent);
    cell.smallest = cell.begin == cell.end ? radius : std::min(cell.smallest, radius);
    ++cell.end;
}

// Stores a block's splats from `first` on and returns its cells.
std::vector<Cell> store_block(CellGrid &grid, std::size_t first, std::span<const Splat> splats,
                              const SplatSource &source) {
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < splats.size(); ++i) {
        const Splat &splat = splats[i];
        const std::size_t at = first + i;
        if (cells.empty() || cells.back().bin != splat.bin) cells.push_back({splat.bin, at, at, {}, {}, 0});
        extend(cells.back(), splat, source.lens().pixel_aspect);
        grid.x[at] = splat.position.x;
        grid.y[at] = splat.position.y;
        grid.radius[at] = std::abs(splat.coc);
        put_values(grid, at, splat, source);
    }
    return cells;
}

// Double sums: they stand for any number of splats.
void sum_cells(CellGrid &grid, double pixel_aspect) {
    grid.sums.assign(grid.cells.size() * grid.size(), 0);
    parallel_for(grid.cells.size(), [&](std::size_t index) {
        const Cell &cell = grid.cells[index];
        if (cell.smallest < 0.5) return; // cannot cover a tile, not even of one pixel
        for (std::size_t i = cell.begin; i < cell.end; ++i) {
            const double weight = 1 / (std::numbers::pi * grid.radius[i] * grid.radius[i] * pixel_aspect);
            for (std::size_t k = 0; k < grid.size(); ++k)
                grid.sums[index * grid.size() + k] += weight * double(grid.value(i)[k]);
        }
    });
}

} // namespace

CellGrid make_cells(const SplatSource &source) {
    const Blocks blocks(source.ldi().windows);
    std::vector<std::size_t> first(blocks.count() + 1, 0);
    parallel_for(blocks.count(), [&](std::size_t block) {
        blocks.for_each_pixel(block, [&](std::size_t pixel) {
            source.for_each(pixel, [&](const Splat &) { ++first[block + 1]; });
        });
    });
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];

    CellGrid grid;
    grid.colours = source.colours().size();
    for (auto *array : {&grid.x, &grid.y, &grid.radius}) array->resize(first.back());
    grid.values.resize(first.back() * grid.size());
    std::vector<std::vector<Cell>> cells(blocks.count());
    parallel_for(blocks.count(), [&](std::size_t block) {
        cells[block] = store_block(grid, first[block], splats_of_block(source, blocks, block), source);
    });
    for (const auto &of_block : cells) grid.cells.insert(grid.cells.end(), of_block.begin(), of_block.end());
    std::stable_sort(grid.cells.begin(), grid.cells.end(),
                     [](const Cell &a, const Cell &b) { return a.bin < b.bin; });
    for (std::size_t i = 0; i < grid.cells.size(); ++i)
        grid.bins += i == 0 || grid.cells[i].bin != grid.cells[i - 1].bin;
    sum_cells(grid, source.lens().pixel_aspect);
    return grid;
}

} // namespace sparselens
