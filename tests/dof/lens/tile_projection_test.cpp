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

constexpr int size = 8, stride = size + 2;

// Computed in double from the position of the drawn sample: all numbers in the test are short enough to be exact in
// float.
int cell_of(const LensSample &lens, double corner_x, double corner_y, double x, double y, double coc) {
    const double column = std::floor(x + coc * double(lens.x) + double(lens.pixel_x) - corner_x) + 1;
    const double row = std::floor(y + coc * double(lens.y) + double(lens.pixel_y) - corner_y) + 1;
    return int(std::clamp(row, 0.0, stride - 1.0)) * stride + int(std::clamp(column, 0.0, stride - 1.0));
}

TEST(TileProjection, SamplesFallWhereTheLensPointSeesThem) {
    const LensSample lens{0.75f, -0.5f, 0.25f, -0.125f, 1};
    const float corner_x = 64, corner_y = 128;
    std::mt19937 random(3);
    std::uniform_int_distribution<int> eighths(-8 * 20, 8 * 20);
    std::vector<float> x, y, coc;
    for (int i = 0; i < 1000; ++i) { // with a remainder for any vector width
        x.push_back(corner_x + float(eighths(random)) / 8);
        y.push_back(corner_y + float(eighths(random)) / 8);
        coc.push_back(float(eighths(random)) / 8);
    }
    x.push_back(corner_x), y.push_back(corner_y), coc.push_back(0);
    std::vector<std::int32_t> cells(x.size(), -1);
    project_to_cells(TileProjection(lens, corner_x, corner_y, stride), x.data(), y.data(), coc.data(),
                     std::uint32_t(x.size()), cells.data());
    for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_EQ(cells[i], cell_of(lens, double(corner_x), double(corner_y), double(x[i]), double(y[i]),
                                    double(coc[i])))
            << i;
}

TEST(TileProjection, WhatIsFarAwayOrNotANumberFallsInTheBorder) {
    const std::vector<float> x = {1e30f, -1e30f, 4, std::nanf("")}, y = {4, 4, -1e30f, 4}, coc = {0, 0, 0, 0};
    std::vector<std::int32_t> cells(4);
    project_to_cells(TileProjection({0, 0, 0, 0, 1}, 0, 0, stride), x.data(), y.data(), coc.data(), 4,
                     cells.data());
    EXPECT_EQ(cells, (std::vector<std::int32_t>{5 * stride + stride - 1, 5 * stride, 5, 5 * stride}));
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
    bounds.set(all, samples);
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
    bounds.set(all, samples);
    for (const float x : {-0.5f, 0.0f, 0.5f})
        EXPECT_EQ(bounds.reached({x, 0, 0, 0, 1}, {0, 64, 0, 64}).size(), 1u) << x;
}

} // namespace
} // namespace sparselens
