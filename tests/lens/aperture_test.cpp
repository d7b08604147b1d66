#include "base/error.h"
#include "lens/aperture.h"
#include "lens/lens_samples.h"
#include "lens/polygon_pixels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sparselens {
namespace {

using std::numbers::pi;

TEST(Aperture, OfTheRoundLensHasTheSameLensPointsBitForBit) {
    for (const ApertureShape &shape : {ApertureShape{}, ApertureShape{.blades = 6, .curvature = 1}}) {
        const auto round = disc_lens_samples(96, 1.5), made = lens_samples(Aperture(shape), 96, 1.5);
        for (std::size_t k = 0; k < round.size(); ++k) {
            EXPECT_EQ(made[k].x, round[k].x);
            EXPECT_EQ(made[k].y, round[k].y);
            EXPECT_EQ(made[k].pixel_x, round[k].pixel_x);
            EXPECT_EQ(made[k].weight, round[k].weight);
            EXPECT_EQ(made[k].behind, no_factors);
        }
    }
}

// The middle of a side is at cos(half a side's angle) from the middle.
TEST(Aperture, HasItsPointsWithinTheBladesEvenInArea) {
    for (const int blades : {3, 6, 9})
        for (const double rotation : {0.0, 25.0}) {
            const auto points = lens_samples(Aperture({.blades = blades, .rotation = rotation}), 2048, 1);
            double square = 0, x = 0, y = 0;
            int half = 0;
            for (const LensSample &p : points) {
                for (int k = 0; k < blades; ++k) {
                    const double at = rotation * pi / 180 + 2 * pi * k / blades;
                    ASSERT_LE(p.x * std::cos(at) - p.y * std::sin(at), std::cos(pi / blades) + 1e-6);
                }
                square += p.x * p.x + p.y * p.y;
                x += p.x;
                y += p.y;
                half += p.x * p.x + p.y * p.y < 0.1f;
            }
            const double n = double(points.size()), c = std::cos(pi / blades);
            EXPECT_NEAR(square / n, (1 + 2 * c * c) / 6, 3e-3) << blades; // the mean over a regular polygon
            EXPECT_NEAR(x / n, 0, 3e-3);
            EXPECT_NEAR(y / n, 0, 3e-3);
            EXPECT_NEAR(half / n, 0.1 * pi / (blades * std::sin(2 * pi / blades) / 2), 5e-3);
        }
}

TEST(Aperture, IsNarrowerWhereItIsSqueezed) {
    const auto round = disc_lens_samples(64, 1), narrow = lens_samples(Aperture({.squeeze = 2}), 64, 1);
    for (std::size_t k = 0; k < round.size(); ++k) {
        EXPECT_EQ(narrow[k].x, round[k].x / 2);
        EXPECT_EQ(narrow[k].y, round[k].y);
    }
    EXPECT_EQ(Aperture({.squeeze = 4}).half_extent(), Imath::V2d(0.25, 1));
}

TEST(Aperture, WeighsSidesBySphericalAberrationWithAMeanOf1) {
    const auto points = lens_samples(Aperture({.blades = 5, .spherical = 0.7}), 4096, 1);
    double behind = 0, in_front = 0;
    for (const LensSample &p : points) behind += double(p.behind[1]), in_front += double(p.in_front[1]);
    EXPECT_NEAR(behind / 4096, 1, 2e-3);
    EXPECT_NEAR(in_front / 4096, 1, 2e-3);
    const Aperture round({.spherical = 0.7}); // the mean is exactly 1, because 2 r^2 - 1 has mean 0
    EXPECT_NEAR(round.weight(true, 1), 1.7, 1e-12);
    EXPECT_NEAR(round.weight(true, 0), 0.3, 1e-12);
    EXPECT_NEAR(round.weight(false, 1), 0.3, 1e-12);
}

TEST(Aperture, WeighsColoursByTheirOwnRimsWithinLimits) {
    const Aperture aperture({.blades = 7, .spherical = {-0.4, 0, 3}});
    EXPECT_TRUE(aperture.coloured());
    EXPECT_TRUE(aperture.two_sided());
    EXPECT_FALSE(aperture.disc());
    for (const bool behind : {true, false})
        for (const double square : {0.0, 0.5, 1.0}) {
            const auto alike = [&](double s) {
                return Aperture({.blades = 7, .spherical = s}).weight(behind, square);
            };
            EXPECT_EQ(aperture.weight(behind, square, 0), alike(-0.4));
            EXPECT_EQ(aperture.weight(behind, square, 1), 1);
            EXPECT_EQ(aperture.weight(behind, square, 2), alike(1));
        }
    EXPECT_FALSE(Aperture({.spherical = 0.5}).coloured());
    std::array<double, 3> behind{}, in_front{};
    for (const LensSample &p : lens_samples(aperture, 4096, 1))
        for (std::size_t k = 0; k < 3; ++k)
            behind[k] += double(p.behind[k]) / 4096, in_front[k] += double(p.in_front[k]) / 4096;
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(behind[k], 1, 2e-3);
        EXPECT_NEAR(in_front[k], 1, 2e-3);
    }
}

TEST(Aperture, OfAPictureHasItsPointsWhereTheLightIs) {
    auto picture = std::make_shared<AperturePicture>(AperturePicture{4, 2, {}});
    // The upper row: black, one red and one white square; the lower row: four green ones. In total R, G and B pass 1.5,
    // 5 and 1.
    const float red[] = {1, 0, 0}, white[] = {1, 1, 1}, green[] = {0, 1, 0}, black[] = {0, 0, 0};
    for (const float *rgb : {black, red, white, black, green, green, green, green})
        picture->rgb.insert(picture->rgb.end(), rgb, rgb + 3);
    const Aperture aperture({.picture = picture});
    EXPECT_TRUE(aperture.coloured());
    EXPECT_EQ(aperture.half_extent(), Imath::V2d(1, 0.5));
    const auto points = lens_samples(aperture, 4096, 1);
    std::array<double, 3> sums{};
    double upper = 0;
    for (const LensSample &p : points) {
        ASSERT_LE(std::abs(p.y), 0.5f);
        ASSERT_FALSE(p.y < -1e-6f && std::abs(p.x) > 0.5f + 1e-6f); // y down: nothing in the upper corners
        for (std::size_t k = 0; k < 3; ++k) sums[k] += double(p.rgb[k]);
        upper += p.y < 0;
    }
    for (const double sum : sums) EXPECT_NEAR(sum / 4096, 1, 5e-3);
    EXPECT_NEAR(upper / 4096, (1 + 0.2 + 1) / 3, 5e-3); // all of R, 1/5 of G, all of B
}

TEST(Aperture, RefusesPicturesThatLetNoLightOfAColourThrough) {
    const auto black = std::make_shared<AperturePicture>(AperturePicture{2, 1, {0, 0, 0, 0, 0, 0}});
    const auto no_blue = std::make_shared<AperturePicture>(AperturePicture{1, 1, {1, 1, 0}});
    EXPECT_THROW(Aperture({.picture = black}), Error);
    EXPECT_THROW(Aperture({.picture = no_blue}), Error);
}

TEST(Outline, CutByACircleIsTheLensOfTwoCircles) {
    const auto circle = aperture_outline({}, 1e-7);
    for (const double d : {0.1, 0.7, 1.5, 1.99}) {
        const auto left = within_unit_circle(circle, {d * 0.6, d * 0.8}, 1e-7);
        const double lens = 2 * std::acos(d / 2) - d / 2 * std::sqrt(4 - d * d);
        EXPECT_NEAR(signed_area(left), lens, 1e-5) << d;
    }
    EXPECT_TRUE(within_unit_circle(circle, {2.1, 0}, 1e-4).empty());
    const auto triangle = aperture_outline({.blades = 3}, 1);
    EXPECT_NEAR(signed_area(within_unit_circle(triangle, {0, 0}, 1e-6)), std::sqrt(27) / 4, 1e-4);
}

} // namespace
} // namespace sparselens
