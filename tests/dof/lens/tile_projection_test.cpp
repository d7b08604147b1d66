#include "dof/lens/tile_projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <span>
#include <vector>

namespace sparselens {
namespace {

// Computed in double: all numbers in the test are short enough to be whole in units.
std::size_t cell_of(const LensSample &lens, const Imath::V2d &corner, double x, double y, double coc) {
    const double column = std::floor(x + coc * double(lens.x) + double(lens.pixel_x) - corner.x),
                 row = std::floor(y + coc * double(lens.y) + double(lens.pixel_y) - corner.y);
    return tile_cells::at(int(std::clamp(column, -2.0, 65.0)), int(std::clamp(row, -2.0, 65.0)));
}

std::vector<std::uint16_t> cells_of(const LensSample &lens, const Imath::V2f &corner, float largest_coc,
                                    const std::vector<float> &x, const std::vector<float> &y,
                                    const std::vector<float> &coc) {
    const kernels::TileUnits units = tile_units(largest_coc, {&lens, 1});
    WholePlaces places;
    places.add(units, corner + Imath::V2f(32), x.data(), y.data(), coc.data(), std::uint32_t(x.size()));
    std::vector<std::uint16_t> cells(places.count());
    project_to_cells(WholeLens(units, lens), places, 0, places.count(), cells.data());
    cells.resize(x.size());
    return cells;
}

// The larger the CoC and the wider the lens, the fewer are the units in a pixel.
TEST(TileProjection, SamplesFallWhereTheLensPointSeesThem) {
    const Imath::V2f corner(64, 128);
    for (const int largest : {20, 100, 400, 1500})
        for (const float wide : {1.0f, 2.0f}) {
            const LensSample lens{0.75f * wide, -0.5f * wide, 0.25f, -0.25f, 1};
            std::mt19937 random(3);
            std::uniform_int_distribution<int> any(-largest, largest);
            std::vector<float> x, y, coc;
            for (int i = 0; i < 1000; ++i) { // with a remainder for any vector width
                coc.push_back(float(any(random)));
                x.push_back(corner.x + 32 - std::round(coc.back() * lens.x) + float(any(random) % 64) + 0.5f);
                y.push_back(corner.y + 32 - std::round(coc.back() * lens.y) + float(any(random) % 64) + 0.5f);
            }
            const std::vector<std::uint16_t> cells = cells_of(lens, corner, float(largest), x, y, coc);
            for (std::size_t i = 0; i < x.size(); ++i)
                EXPECT_EQ(cells[i],
                          cell_of(lens, Imath::V2d(corner), double(x[i]), double(y[i]), double(coc[i])))
                    << largest << " " << wide << " " << i;
        }
}

// Not by rounding alone, however near to its edge the lens point looks through a pixel; a skewed lens moves it far.
TEST(TileProjection, WhatIsInFocusLeavesItsPixelByAShiftOfHalfAPixelOrMore) {
    for (const float shift : {-0.5f, -0.499f, 0.498f, 0.4999f, -7.25f, 5.75f}) {
        const LensSample lens{1, 1, shift, -0.5f, 1};
        const std::vector<float> x = {3.5f, 40.5f}, y = {9.5f, 20.5f}, coc = {0, 0};
        const std::vector<std::uint16_t> cells = cells_of(lens, {0, 0}, 20, x, y, coc);
        for (std::size_t i = 0; i < x.size(); ++i)
            EXPECT_EQ(cells[i], cell_of(lens, {0, 0}, double(x[i]), double(y[i]), 0)) << shift;
    }
}

TEST(TileProjection, WhatIsFarAwayOrNotANumberFallsInTheBorder) {
    const float inf = std::numeric_limits<float>::infinity();
    const std::vector<float> x = {1e30f, -inf, 4, 5, 6, std::nanf("")}, y = {4, 4, -1e30f, 4, 4, 4},
                             coc = {0, 0, 0, inf, -inf, 0};
    const std::vector<std::uint16_t> cells = cells_of({1, 0, 0, 0, 1}, {0, 0}, inf, x, y, coc);
    const std::vector<std::size_t> expected = {tile_cells::at(65, 4), tile_cells::at(-2, 4),
                                               tile_cells::at(4, -2), tile_cells::at(65, 4),
                                               tile_cells::at(-2, 4), tile_cells::at(65, 4)};
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(cells[i], expected[i]) << i;
}

// Blocks of two samples each, placed at random around a tile.
BlockedSamples random_blocks(std::uint32_t count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-60, 124), nearby(-8, 8), coc(-30, 30);
    BlockedSamples samples;
    for (std::uint32_t b = 0; b < count; ++b) {
        SampleBlock block{};
        block.begin = 2 * b;
        block.opaque_end = block.end = 2 * b + 2;
        const float x = place(random), y = place(random), c = coc(random);
        for (int i = 0; i < 2; ++i) {
            samples.x.push_back(x + nearby(random));
            samples.y.push_back(y + nearby(random));
            samples.coc.push_back(c + nearby(random) / 8);
            samples.upper.push_back(kernels::upper_of_depth(1));
            samples.source.push_back(0);
        }
        bound(block, samples);
        samples.blocks.push_back(block);
    }
    return samples;
}

TEST(BlockBounds, NoBlockIsMissedThatALensPointBringsInAndFewOthersAreFound) {
    const BlockedSamples samples = random_blocks(500);
    std::vector<std::uint32_t> all(samples.blocks.size());
    std::iota(all.begin(), all.end(), 0u);
    BlockBounds bounds;
    bounds.set(all, samples, tile_units(40, {}));
    std::size_t found = 0, needed = 0;
    for (const LensSample &lens : {LensSample{0.7f, -0.6f, 0.4f, -0.4f, 1},
                                   LensSample{-0.9f, 0.1f, -0.5f, 0.3f, 1}, LensSample{0, 0, 0, 0, 1}}) {
        const std::span<const std::uint32_t> reached = bounds.reached(lens, {-1, 65, -1, 65});
        EXPECT_TRUE(std::ranges::is_sorted(reached));
        for (const std::uint32_t b : all) {
            const auto inside = [&](std::uint32_t i) {
                const float x = samples.x[i] + samples.coc[i] * lens.x + lens.pixel_x,
                            y = samples.y[i] + samples.coc[i] * lens.y + lens.pixel_y;
                return x >= -1 && x < 65 && y >= -1 && y < 65;
            };
            const bool is_found = std::ranges::binary_search(reached, b);
            const bool is_needed = inside(2 * b) || inside(2 * b + 1);
            EXPECT_TRUE(is_found || !is_needed) << b;
            found += is_found;
            needed += is_needed;
        }
    }
    EXPECT_GT(needed, 100u);
    EXPECT_LT(found, needed + needed / 4);
}

TEST(BlockBounds, ASampleOutOfAllReachHidesNoneOfItsBlock) {
    BlockedSamples samples = random_blocks(1);
    samples.x = samples.y = {30, 31};
    samples.coc = {-std::numeric_limits<float>::infinity(), 0};
    bound(samples.blocks[0], samples);
    BlockBounds bounds;
    const std::vector<std::uint32_t> all = {0};
    bounds.set(all, samples, tile_units(40, {}));
    for (const float x : {-0.5f, 0.0f, 0.5f})
        EXPECT_EQ(bounds.reached({x, 0, 0, 0, 1}, {0, 64, 0, 64}).size(), 1u) << x;
}

} // namespace
} // namespace sparselens
