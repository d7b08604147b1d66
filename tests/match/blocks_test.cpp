#include "match/blocks.h"
#include "match/patterns.h"
#include "match/tuning.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

constexpr double least = MatchTuning::least_error * MatchTuning::least_error;

// A plate of these factors of R, G and B, with a quadratic tone curve.
Grey graded(const Rgb &shown, float r, float g, float b) {
    Grey plate{shown.grid, {}};
    for (std::size_t i = 0; i < shown.grid.size(); ++i) {
        const float v = (shown.rgb[0][i] + shown.rgb[1][i] + shown.rgb[2][i]) / 3;
        plate.values.push_back(0.1f + r * shown.rgb[0][i] + g * shown.rgb[1][i] + b * shown.rgb[2][i] -
                               0.3f * v * v);
    }
    return plate;
}

TEST(FitBlocks, exposure_and_a_quadratic_tone_curve_do_not_count) {
    const Rgb shown = test::waves(32, 32);
    const Grey plate = graded(shown, 0.3f, 0.3f, 0.3f);
    for (const BlockFit &block : fit_blocks(plate, test::all_usable(plate.grid), shown, {})) {
        EXPECT_EQ(block.pixels, 256);
        EXPECT_GT(block.before, 5e-4);
        EXPECT_LT(block.left, 1.001 * least);
    }
}

// The factors of colours are drawn towards each other, by what is left without them.
TEST(FitBlocks, a_grade_hardly_counts) {
    const Rgb shown = test::waves(32, 32);
    const Grey plate = graded(shown, 0.5f, 0.2f, 0.4f);
    for (const BlockFit &block : fit_blocks(plate, test::all_usable(plate.grid), shown, {}))
        EXPECT_LT(block.left, 2e-3 * block.before);
}

// The plate adds squares of 0.05. In the gathered picture, which is nearly grey, red has a hundredth of them by chance.
TEST(FitBlocks, a_trace_of_colour_explains_nothing) {
    const auto squares = [](double x, double y) { return std::fmod(x + y, 2) == 0 ? 1.0 : -1.0; };
    const auto grey = [](double x, double y) { return 0.5 + 0.1 * std::sin(0.4 * x) * std::cos(0.3 * y); };
    const Rgb change = test::colours(16, 16, [&](double x, double y, std::size_t) { return squares(x, y); });
    const Rgb shown = test::colours(16, 16, [&](double x, double y, std::size_t k) {
        return grey(x, y) + (k == 0 ? 5e-4 : -2.5e-4) * squares(x, y);
    });
    const Grey plate = brightness(test::colours(
        16, 16, [&](double x, double y, std::size_t) { return grey(x, y) + 0.05 * squares(x, y); }));
    const BlockFit block =
        fit_blocks(plate, test::all_usable(plate.grid), shown, std::vector{change}).front();
    EXPECT_NEAR(block.left, 0.05 * 0.05, 1e-4);
    EXPECT_NEAR(block.pull[0] / block.stiffness[0][0], 0.05, 1e-3);
}

TEST(FitBlocks, the_shift_of_the_plate_is_found) {
    const auto wave = [](double x, double y) {
        return 0.5 + 0.2 * std::sin(0.4 * x) + 0.2 * std::cos(0.3 * y);
    };
    const Rgb shown = test::colours(32, 32, [&](double x, double y, std::size_t) { return wave(x, y); });
    const Grey plate = brightness(
        test::colours(32, 32, [&](double x, double y, std::size_t) { return wave(x - 0.2, y + 0.1); }));
    const BlockFit block = fit_blocks(plate, test::all_usable(plate.grid), shown, {}).front();
    EXPECT_NEAR(block.shift_x, 0.2, 0.02);
    EXPECT_NEAR(block.shift_y, -0.1, 0.02);
}

// A lamp that shines through a gap of the LDI, say.
TEST(FitBlocks, a_few_wrong_pixels_hardly_count) {
    const auto wave = [](double x, double y) {
        return 0.5 + 0.2 * std::sin(0.4 * x) + 0.2 * std::cos(0.3 * y);
    };
    const Rgb shown = test::colours(32, 32, [&](double x, double y, std::size_t) { return wave(x, y); });
    Grey plate = brightness(
        test::colours(32, 32, [&](double x, double y, std::size_t) { return wave(x - 0.2, y + 0.1); }));
    for (const int x : {3, 4, 5, 6})
        for (const int y : {2, 3, 4}) plate.values[plate.grid.index(Imath::V2i(x, y))] = 1;
    const BlockFit block = fit_blocks(plate, test::all_usable(plate.grid), shown, {}).front();
    EXPECT_NEAR(block.shift_x, 0.2, 0.05);
    EXPECT_NEAR(block.shift_y, -0.1, 0.05);
}

// The pull over the stiffness is the amount of the change that the plate has.
TEST(FitBlocks, a_change_is_measured) {
    const Rgb shown = test::waves(16, 16);
    Rgb change = test::colours(16, 16, [](double x, double y, std::size_t) { return std::sin(1.1 * x * y); });
    Rgb plate = shown;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < plate.grid.size(); ++i) plate.rgb[k][i] += 0.03f * change.rgb[k][i];
    const std::vector<Rgb> changes{change};
    const BlockFit block =
        fit_blocks(brightness(plate), test::all_usable(plate.grid), shown, changes).front();
    EXPECT_NEAR(block.pull[0] / block.stiffness[0][0], 0.03, 0.003);
    EXPECT_NEAR(block.pull[0] * block.pull[0] / block.stiffness[0][0] / (block.pixels * block.left), 1, 0.02);
}

TEST(FitBlocks, a_change_is_measured_through_a_grade_and_a_tone_curve) {
    const Rgb shown = test::waves(16, 16);
    Rgb changed = shown;
    const Rgb change =
        test::colours(16, 16, [](double x, double y, std::size_t) { return std::sin(1.1 * x * y); });
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < shown.grid.size(); ++i) changed.rgb[k][i] += 0.003f * change.rgb[k][i];
    const BlockFit block = fit_blocks(graded(changed, 0.15f, 0.15f, 0.15f), test::all_usable(shown.grid),
                                      shown, std::vector{change})
                               .front();
    EXPECT_NEAR(block.pull[0] / block.stiffness[0][0], 0.003, 0.0003);
}

TEST(FitBlocks, unusable_pixels_are_not_compared) {
    const Rgb shown = test::waves(32, 16);
    Grey plate = brightness(shown);
    std::vector<std::uint8_t> usable = test::all_usable(plate.grid);
    for (std::size_t i = 0; i < usable.size(); i += 7) usable[i] = 0, plate.values[i] = 100;
    for (int y = 0; y < 16; ++y)
        for (int x = 16; x < 24; ++x) usable[plate.grid.index(Imath::V2i(x, y))] = 0;
    const std::vector<BlockFit> blocks = fit_blocks(plate, usable, shown, {});
    EXPECT_LT(blocks[0].left, 1.001 * least);
    EXPECT_EQ(blocks[1].pixels, 0) << "half of it is unusable";
    EXPECT_EQ(blocks[1].likelihood, 0);
}

} // namespace
} // namespace sparselens
