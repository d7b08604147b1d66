#include "support/ldi_samples.h"
#include "support/views.h"
#include "view/flat_pixels.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

constexpr float sky = 1e10f;
constexpr int width = 120, height = 90;

// A wall of Z 6, of 0.5 plus noise; random speckles with the wall's colour, and holes with the colour of the sky.
struct Wall {
    double speckled = 0, holes = 0;
    bool is_speckle(int x, int y) const { return random_unit(x, y, 1) < speckled; }
    bool is_hole(int x, int y) const { return !is_speckle(x, y) && random_unit(x, y, 2) < holes; }

    View view() const {
        return make_view(windows_of_size(width, height), {0, 0}, [&](int x, int y) {
            const float noise = 0.1f * float(random_unit(x, y, 3) - 0.5);
            const bool hole = is_hole(x, y);
            return ViewPixel{.z = hole || is_speckle(x, y) ? sky : 6 + 0.01f * float(x),
                             .r = hole ? 0.2f : 0.5f + noise,
                             .g = hole ? 0.5f : 0.4f + noise,
                             .b = hole ? 1.5f : 0.3f + noise};
        });
    }
};

TEST(Speckles, TakeTheDepthOfTheWallAroundThem) {
    for (const double speckled : {0.05, 0.2, 0.4}) {
        View view = Wall{speckled}.view();
        std::size_t speckles = 0, left = 0;
        for (const float z : view.z) speckles += z == sky;
        const std::size_t repaired = repair_speckles(view);
        for (int y = 1; y + 1 < height; ++y) // corners have three neighbours, borders five
            for (int x = 1; x + 1 < width; ++x) {
                const float z = view.z[std::size_t(y * width + x)];
                if (z == sky)
                    ++left;
                else
                    ASSERT_NEAR(z, 6 + 0.01f * float(x), 0.021f)
                        << x << " " << y; // of a neighbour, or a pixel two away
            }
        EXPECT_LE(repaired, speckles);
        EXPECT_GE(repaired + 2 * (width + height), speckles);
        EXPECT_LE(left, speckled < 0.1 ? 0u : speckles / 20) << speckled;
    }
}

TEST(Speckles, HolesThatShowTheSkyStay) {
    View view = Wall{0.05, 0.01}.view();
    repair_speckles(view);
    for (int y = 1; y + 1 < height; ++y)
        for (int x = 1; x + 1 < width; ++x)
            if (Wall{0.05, 0.01}.is_hole(x, y)) {
                EXPECT_EQ(view.z[std::size_t(y * width + x)], sky);
            }
}

TEST(Speckles, PicturesWithoutThemStay) {
    const View whole = Wall{}.view(), holes = Wall{0, 0.05}.view(), few = Wall{0.001}.view();
    // Half of it is sky with the wall's own colour: neither an edge nor a corner is a speckle.
    const View half = make_view(windows_of_size(width, height), {0, 0}, [](int x, int y) {
        return ViewPixel{.z = x < 60 || y < 45 ? 6.0f : sky, .r = 0.5f, .g = 0.4f, .b = 0.3f};
    });
    for (const View &given : {whole, holes, few, half}) {
        View view = given;
        EXPECT_EQ(repair_speckles(view), 0u);
        EXPECT_EQ(view.z, given.z);
    }
}

TEST(Speckles, WhatIsPartlyCoveredStays) {
    View view = Wall{0.05}.view();
    const std::size_t alpha = find_channel(view.image.channels, "A");
    ASSERT_NE(alpha, npos);
    for (std::size_t i = 0; i < view.z.size(); ++i)
        if (view.z[i] == sky) view.image.plane(alpha)[i] = 0.5f;
    EXPECT_EQ(repair_speckles(view), 0u);
}

} // namespace
} // namespace sparselens
