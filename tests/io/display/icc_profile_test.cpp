#include "io/display/icc_profile.h"
#include "support/profiles.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace sparselens {
namespace {

std::array<float, 3> through(const std::string &profile, ProfileDirection direction,
                             std::array<float, 3> colour) {
    const auto transform = transform_of_profile(profile, direction);
    if (!transform) return {-9, -9, -9};
    transform->apply({&colour[0], 1}, {&colour[1], 1}, {&colour[2], 1}, nullptr);
    return colour;
}
void expect_near(const std::array<float, 3> &found, const std::array<double, 3> &wanted, double by) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], wanted[k], by) << k;
}

// Linear Rec.709 of a colour of Display P3, by the matrix of both spaces (their whites are the same).
std::array<double, 3> rec709_of_p3(double r, double g, double b) {
    return {1.2249 * r - 0.2249 * g, -0.0420 * r + 1.0420 * g, -0.0197 * r - 0.0786 * g + 1.0983 * b};
}

TEST(IccProfile, ColoursComeFromItsCurvesAndPrimaries) {
    const double half = std::pow((0.5 + 0.055) / 1.055, 2.4);
    expect_near(through(profile_of(p3, srgb_curve), ProfileDirection::to_linear, {1, 0.5f, 0.02f}),
                rec709_of_p3(1, half, 0.02 / 12.92), 2e-3);
    expect_near(through(profile_of(srgb, srgb_curve), ProfileDirection::to_linear, {1, 0.5f, 0.02f}),
                {1, half, 0.02 / 12.92}, 5e-4);
    const std::string power = "curv" + big(0) + big(1) + big(563, 2); // Adobe RGB's
    const double fifth = std::pow(0.2, 563 / 256.0);
    expect_near(through(profile_of(srgb, power), ProfileDirection::to_linear, {0.2f, 0.2f, 0.2f}),
                {fifth, fifth, fifth}, 1e-4);
    const std::string listed = "curv" + big(0) + big(3) + big(0, 2) + big(13107, 2) + big(65535, 2);
    expect_near(through(profile_of(srgb, listed), ProfileDirection::to_linear, {0.5f, 0.25f, 0.75f}),
                {0.2, 0.1, 0.6}, 1e-3);
    expect_near(
        through(profile_of(srgb, "curv" + big(0) + big(0)), ProfileDirection::to_linear, {0.3f, 0.3f, 0.3f}),
        {0.3, 0.3, 0.3}, 1e-3);
}

TEST(IccProfile, ColoursGoBackAsTheyCame) {
    const std::string power = "curv" + big(0) + big(1) + big(563, 2);
    for (const std::string &profile : {profile_of(p3, srgb_curve), profile_of(p3, power)})
        for (int n = 0; n < 256; n += 5) {
            const std::array colour{float(n) / 255, float(255 - n) / 255, float(n * 7 % 256) / 255};
            const auto back = through(profile, ProfileDirection::from_linear,
                                      through(profile, ProfileDirection::to_linear, colour));
            expect_near(back, {double(colour[0]), double(colour[1]), double(colour[2])}, 3e-4);
        }
}

TEST(IccProfile, OthersAreNoProfilesOfCurves) {
    const std::string whole = profile_of(p3, srgb_curve);
    EXPECT_TRUE(is_rgb_profile(whole));
    std::string inks = whole;
    inks.replace(16, 4, "CMYK");
    EXPECT_FALSE(is_rgb_profile(inks));
    for (std::size_t size = 0; size < whole.size(); size += 7) {
        std::string part = whole.substr(0, size);
        EXPECT_FALSE(is_rgb_profile(part));
        if (size >= 4) part.replace(0, 4, big(std::uint32_t(size))); // says its own size
        (void)transform_of_profile(part, ProfileDirection::to_linear);
    }
    std::string falls = "curv" + big(0) + big(3) + big(0, 2) + big(40000, 2) + big(3, 2);
    EXPECT_FALSE(transform_of_profile(profile_of(p3, falls), ProfileDirection::to_linear));
    EXPECT_FALSE(transform_of_profile(profile_of(p3, "mft2"), ProfileDirection::to_linear));
}

} // namespace
} // namespace sparselens
