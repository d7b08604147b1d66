#include "deep/checks/picture_checks.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace sparselens {
namespace {

// A floor from 1 to 9 before a wall, with depths written as `value`.
bool seems_white_near(const std::function<double(double z)> &value) {
    const ArrayGrid grid(64, 64);
    std::vector<float> depths;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const double z = y < 16 ? 9 : 1 / (1.0 / 9 + (1 - 1.0 / 9) * (y - 15) / 48.0);
            depths.push_back(float(value(z)));
        }
    return looks_white_near(grid, depths);
}

TEST(WhiteNear, OnlyWhatFallsWithTheDistanceFromOneIs) {
    EXPECT_TRUE(seems_white_near([](double z) { return (10 - z) / 9.5; }));
    EXPECT_TRUE(seems_white_near([](double z) { return (100 - z) / 99.9; }));
    EXPECT_FALSE(seems_white_near([](double z) { return z; })) << "above 1";
    EXPECT_FALSE(seems_white_near([](double z) { return z / 10; })) << "planar, of a table top";
    EXPECT_FALSE(seems_white_near([](double z) { return (z - 0.5) / 9.5; })) << "black near";
    EXPECT_FALSE(seems_white_near([](double z) { return 1 / z; })) << "inverse";
    EXPECT_FALSE(seems_white_near([](double) { return 0.5; })) << "nothing recedes";
}

} // namespace
} // namespace sparselens
