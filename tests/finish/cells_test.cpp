// Cells of pixels: means over them, and interpolation between them.
#include "finish/window_means.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

// `of(x, y)` at the pixels, averaged over cells.
template <typename Of>
Values means(const Cells &cells, const Of &of) {
    Values plane(cells.grid().size(), 0.0f);
    const int width = cells.pixels().width();
    for (std::size_t row = 0; row < std::size_t(cells.grid().height()); ++row) {
        const auto [begin, end] = cells.rows(row);
        for (std::size_t y = begin; y < end; ++y)
            for (int x = 0; x < width; x += int(run_length)) {
                Run run{};
                for (int i = 0; i < int(run_length) && x + i < width; ++i)
                    run[std::size_t(i)] = of(x + i, int(y));
                cells.add(run, std::size_t(x), cells.of_row(plane, row));
            }
        cells.divide(row, cells.of_row(plane, row));
    }
    return plane;
}

// Sides that are not multiples of runs and cells.
TEST(Cells, AreTheMeansOfTheirPixels) {
    for (const ArrayGrid &grid : {ArrayGrid(131, 21), ArrayGrid(64, 8), ArrayGrid(1, 9), ArrayGrid(9, 1)})
        for (const int side : {1, 2, 4, 8}) {
            const Cells cells(grid, side);
            const auto of = [](int x, int y) { return float(x * 7 % 5) - float(y * 3 % 4); };
            const Values found = means(cells, of);
            const Tiles tiles(grid.box(), side);
            ASSERT_EQ(found.size(), tiles.count());
            for (std::size_t t = 0; t < tiles.count(); ++t) {
                const PositionBox box = tiles.box(t);
                float sum = 0;
                for (int y = box.min.row; y <= box.max.row; ++y)
                    for (int x = box.min.column; x <= box.max.column; ++x) sum += of(x, y);
                const Imath::V2i size = box.max - box.min + Imath::V2i(1);
                ASSERT_NEAR(found[t], sum / float(size.x * size.y), 1e-5f) << side << ' ' << t;
            }
        }
}

// A slope is the same slope between the middles of cells, and constant beyond the outermost ones.
TEST(Cells, SlopesAreInterpolatedExactly) {
    const ArrayGrid grid(64, 24);
    for (const int side : {1, 2, 4, 8}) {
        const Cells cells(grid, side);
        const Values plane = means(cells, [](int x, int y) { return float(2 * x + 5 * y); });
        std::vector<float> row;
        for (int y = side / 2; y < grid.height() - side / 2; ++y) {
            cells.interpolate(plane, std::size_t(y), row);
            ASSERT_GE(row.size(), 64u);
            for (int x = side / 2; x < grid.width() - side / 2; ++x)
                ASSERT_NEAR(row[std::size_t(x)], float(2 * x + 5 * y), 1e-4f) << side << ' ' << x << ' ' << y;
        }
        cells.interpolate(plane, 0, row);
        EXPECT_NEAR(row[0], plane[0], 1e-5f);
    }
}

TEST(Cells, AConstantStaysConstant) {
    for (const ArrayGrid &grid : {ArrayGrid(131, 21), ArrayGrid(1, 1)})
        for (const int side : {1, 4}) {
            const Cells cells(grid, side);
            const Values plane = means(cells, [](int, int) { return 0.7f; });
            std::vector<float> row;
            for (int y = 0; y < grid.height(); ++y) {
                cells.interpolate(plane, std::size_t(y), row);
                for (int x = 0; x < grid.width(); ++x) ASSERT_NEAR(row[std::size_t(x)], 0.7f, 1e-6f);
            }
        }
}

} // namespace
} // namespace sparselens
