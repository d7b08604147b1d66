// Means over windows, compared with means computed pixel by pixel.
#include "finish/window_means.h"

#include <gtest/gtest.h>

#include <random>

namespace sparselens {
namespace {

Values random_values(const ArrayGrid &grid) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1, 3);
    Values values(grid.size());
    for (float &v : values) v = uniform(random);
    return values;
}

Values box_mean_slowly(const Values &values, const ArrayGrid &grid, int radius) {
    Values means(grid.size());
    for (int y = 0; y < grid.height(); ++y)
        for (int x = 0; x < grid.width(); ++x) {
            double sum = 0;
            int count = 0;
            for (int v = y - radius; v <= y + radius; ++v)
                for (int u = x - radius; u <= x + radius; ++u)
                    if (grid.contains(Position(u, v))) {
                        sum += double(values[grid.index(Position(u, v))]);
                        ++count;
                    }
            means[grid.index(Position(x, y))] = float(sum / count);
        }
    return means;
}

void expect_near(const Values &found, const Values &expected, float bound) {
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], expected[i], bound) << i;
}

// Sides that are not multiples of 16 lanes, and a radius larger than the picture.
TEST(WindowMeans, AreTheMeansOverTheSquareWithinThePicture) {
    for (const ArrayGrid &grid : {ArrayGrid(37, 21), ArrayGrid(1, 40), ArrayGrid(40, 1), ArrayGrid(1, 1)})
        for (const int radius : {0, 1, 3, 10, 64}) {
            const Values values = random_values(grid);
            Values box = values, soft = values;
            box_mean(box, grid, radius);
            expect_near(box, box_mean_slowly(values, grid, radius), 1e-6f);
            soft_mean(soft, grid, radius);
            // Windows of rows and of columns do not depend on each other, so the order of the passes does not matter.
            Values slowly = values;
            for (int pass = 0; pass < 3; ++pass) slowly = box_mean_slowly(slowly, grid, radius);
            expect_near(soft, slowly, 2e-6f);
        }
}

TEST(WindowMeans, AConstantStaysConstant) {
    const ArrayGrid grid(33, 18);
    Values values(grid.size(), 0.7f);
    soft_mean(values, grid, 5);
    for (const float v : values) EXPECT_FLOAT_EQ(v, 0.7f);
}

TEST(WindowMeans, ALampLeavesNothingBehind) {
    const ArrayGrid grid(64, 8);
    Values values(grid.size(), 1e-3f);
    for (int y = 0; y < 8; ++y) values[grid.index(Position(3, y))] = 1e4f;
    box_mean(values, grid, 2);
    for (int x = 6; x < 64; ++x) EXPECT_FLOAT_EQ(values[grid.index(Position(x, 4))], 1e-3f) << x;
}

} // namespace
} // namespace sparselens
