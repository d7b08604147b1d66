#include "match/patterns.h"
#include "match/tone_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sparselens {
namespace {

// A slope with three bright discs, as a plate shows lamps.
Rgb lamps(double brightness) {
    return test::colours(96, 64, [=](double x, double y, std::size_t) {
        for (const double at : {20.0, 50.0, 80.0})
            if (std::hypot(x - at, y - 30) < 5) return brightness;
        return 0.2 + 0.003 * x;
    });
}

Rgb raised(Rgb plate) {
    for (std::vector<float> &plane : plate.rgb) raise_clipped(plane);
    return plate;
}

TEST(Clipping, raises_the_lamps_that_a_plate_clips_and_nothing_else) {
    const Rgb plate = lamps(1), result = raised(plate);
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < plate.grid.size(); ++i) {
            if (plate.rgb[k][i] == 1)
                ASSERT_GT(result.rgb[k][i], 2) << i;
            else
                ASSERT_EQ(result.rgb[k][i], plate.rgb[k][i]) << i;
        }
}

// 19 is 0.95 times the largest value.
TEST(Clipping, the_least_clipped_value_is_raised_too) {
    std::vector<float> plane{20, 20, 20, 19, 18.99f};
    raise_clipped(plane);
    EXPECT_EQ(plane, (std::vector<float>{80, 80, 80, 76, 18.99f}));
}

TEST(Clipping, only_clipped_channels_are_raised) {
    Rgb plate = lamps(1);
    plate.rgb[2] = test::colours(96, 64, [](double x, double, std::size_t) { return 0.005 * x; }).rgb[2];
    const Rgb result = raised(plate);
    EXPECT_GT(result.rgb[0][plate.grid.index(Imath::V2i(50, 30))], 2);
    EXPECT_EQ(result.rgb[2], plate.rgb[2]);
}

TEST(Clipping, grain_does_not_hide_it) {
    Rgb plate = lamps(1);
    std::uint32_t state = 1;
    for (std::vector<float> &plane : plate.rgb)
        for (float &v : plane) {
            state = state * 1664525u + 1013904223u;
            v = std::min(v + 0.06f * (float(state >> 8) / float(1 << 24) - 0.5f), 1.0f);
        }
    const Rgb result = raised(plate);
    EXPECT_GT(result.rgb[0][plate.grid.index(Imath::V2i(50, 30))], 2);
    EXPECT_LT(result.rgb[0][plate.grid.index(Imath::V2i(35, 30))], 1);
}

TEST(Clipping, a_picture_that_fades_to_its_largest_value_has_none) {
    const Rgb plate =
        test::colours(96, 64, [](double x, double y, std::size_t) { return 0.1 + 0.005 * x + 0.004 * y; });
    EXPECT_EQ(raised(plate).rgb, plate.rgb);
}

TEST(Clipping, a_black_plate_has_none) {
    const Rgb plate = test::colours(32, 32, [](double, double, std::size_t) { return 0.0; });
    EXPECT_EQ(raised(plate).rgb, plate.rgb);
}

} // namespace
} // namespace sparselens
