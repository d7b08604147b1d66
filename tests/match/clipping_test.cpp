#include "match/clipping.h"
#include "match/patterns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sparselens {
namespace {

// A slope with three bright discs, as a plate shows lamps.
Colours lamps(double brightness) {
    return test::colours(96, 64, [=](double x, double y, std::size_t) {
        for (const double at : {20.0, 50.0, 80.0})
            if (std::hypot(x - at, y - 30) < 5) return brightness;
        return 0.2 + 0.003 * x;
    });
}

TEST(Clipping, finds_the_lamps_that_a_plate_clips) {
    const Colours plate = lamps(1);
    const std::vector<std::uint8_t> clipped = clipped_pixels(plate);
    for (std::size_t i = 0; i < clipped.size(); ++i) ASSERT_EQ(clipped[i] != 0, plate.rgb[0][i] == 1) << i;
}

TEST(Clipping, grain_does_not_hide_it) {
    Colours plate = lamps(1);
    std::uint32_t state = 1;
    for (std::vector<float> &plane : plate.rgb)
        for (float &v : plane) {
            state = state * 1664525u + 1013904223u;
            v = std::min(v + 0.06f * (float(state >> 8) / float(1 << 24) - 0.5f), 1.0f);
        }
    const std::vector<std::uint8_t> clipped = clipped_pixels(plate);
    EXPECT_EQ(clipped[plate.grid.index(50, 30)], 1);
    EXPECT_EQ(clipped[plate.grid.index(35, 30)], 0);
}

TEST(Clipping, a_picture_that_fades_to_its_largest_value_has_none) {
    const std::vector<std::uint8_t> clipped = clipped_pixels(
        test::colours(96, 64, [](double x, double y, std::size_t) { return 0.1 + 0.005 * x + 0.004 * y; }));
    EXPECT_EQ(std::ranges::count(clipped, 1), 0);
}

TEST(Clipping, a_black_plate_has_none) {
    const std::vector<std::uint8_t> clipped =
        clipped_pixels(test::colours(32, 32, [](double, double, std::size_t) { return 0.0; }));
    EXPECT_EQ(std::ranges::count(clipped, 1), 0);
}

} // namespace
} // namespace sparselens
