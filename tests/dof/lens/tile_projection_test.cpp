#include "dof/lens/tile_projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace sparselens {
namespace {

constexpr int size = 8, stride = size + 2;

// In double, from where the sample is drawn: all numbers of the test are short enough for float to be exact.
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
    for (int i = 0; i < 1000; ++i) { // an odd remainder for whatever the compiler takes at once
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

} // namespace
} // namespace sparselens
