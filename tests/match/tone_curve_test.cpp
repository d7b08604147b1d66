#include "match/patterns.h"
#include "match/tone_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sparselens {
namespace {

// A camera's curve, other in each channel: exposure, a toe and a shoulder, and clipping.
float filmed(float v, std::size_t k) {
    const double s = std::pow(double(v) * (0.7 + 0.2 * double(k)), 0.45);
    return float(std::min(s * s * (3 - 2 * s), 0.6));
}

Rgb filmed(Rgb of) {
    for (std::size_t k = 0; k < 3; ++k)
        for (float &v : of.rgb[k]) v = filmed(v, k);
    return of;
}

TEST(ToneCurve, a_picture_gets_the_curve_of_the_plate) {
    const Rgb shown = test::waves(96, 64), plate = filmed(shown);
    const Rgb curved = with_curve_of(plate, test::all_usable(shown.grid), shown);
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < shown.grid.size(); ++i)
            ASSERT_NEAR(curved.rgb[k][i], plate.rgb[k][i], 0.01) << k << ", " << i;
}

// An actor over a third of the plate, with values of their own, hardly bends the curve, whatever is not usable below.
TEST(ToneCurve, other_content_over_a_third_hardly_counts) {
    for (const int unusable_rows : {0, 128}) {
        const int height = 64 + unusable_rows;
        const Rgb shown = test::waves(96, height), plain = filmed(shown);
        const Rgb actor = test::colours(96, height, [](double x, double y, std::size_t) {
            return std::fmod(x + 2 * y, 9.0) < 4 ? 0.9 : 0.05;
        });
        Rgb plate = plain;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < shown.grid.size(); ++i)
                if (i % 96 >= 32 && i % 96 < 64) plate.rgb[k][i] = actor.rgb[k][i];
        std::vector<std::uint8_t> usable = test::all_usable(shown.grid);
        std::fill(usable.begin() + 64 * 96, usable.end(), 0);
        const Rgb curved = with_curve_of(plate, usable, shown);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < 64 * 96; ++i)
                ASSERT_NEAR(curved.rgb[k][i], plain.rgb[k][i], 0.02) << k << ", " << i;
    }
}

// A search compares pictures that differ a little. Their curves must differ a little, too.
TEST(ToneCurve, it_changes_steadily_with_the_picture) {
    const Rgb shown = test::waves(96, 64);
    Rgb plate = filmed(shown);
    for (std::vector<float> &plane : plate.rgb)
        for (float &v : plane) v = std::round(v * 255) / 255; // as in a JPEG
    const auto curved = [&](float by) {
        Rgb other = shown;
        for (std::vector<float> &plane : other.rgb)
            for (float &v : plane) v += by * v * (1 - v);
        return with_curve_of(plate, test::all_usable(shown.grid), other);
    };
    for (int step = 0; step < 20; ++step) {
        const Rgb a = curved(0.002f * float(step)), b = curved(0.002f * float(step + 1));
        double squares = 0;
        for (std::size_t i = 0; i < shown.grid.size(); ++i) squares += std::pow(a.rgb[1][i] - b.rgb[1][i], 2);
        EXPECT_LT(std::sqrt(squares / double(shown.grid.size())), 0.001) << step;
    }
}

TEST(ToneCurve, it_never_falls) {
    const Rgb shown = test::waves(64, 64), other = test::waves(64, 64, [](double, double) { return -1.0; });
    const Rgb curved = with_curve_of(other, test::all_usable(shown.grid), shown);
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 1; i < shown.grid.size(); ++i) {
            const float change = curved.rgb[k][i] - curved.rgb[k][i - 1];
            if (shown.rgb[k][i] >= shown.rgb[k][i - 1])
                ASSERT_GE(change, 0);
            else
                ASSERT_LE(change, 0);
        }
}

TEST(ToneCurve, pixels_that_are_not_usable_do_not_count) {
    const Rgb shown = test::waves(64, 64), plain = filmed(shown);
    Rgb plate = plain;
    std::vector<std::uint8_t> usable = test::all_usable(shown.grid);
    for (std::size_t i = 0; i < usable.size(); i += 3) {
        usable[i] = 0;
        for (std::vector<float> &plane : plate.rgb) plane[i] = NAN;
    }
    const Rgb curved = with_curve_of(plate, usable, shown);
    for (std::size_t i = 0; i < shown.grid.size(); ++i)
        ASSERT_NEAR(curved.rgb[1][i], plain.rgb[1][i], 0.01) << i;
}

} // namespace
} // namespace sparselens
