#include "measure/flip.h"
#include "measure/flip_reference.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>

namespace sparselens {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

Image constant(int width, int height, const std::array<float, 3> &rgb) {
    Image image(windows_of_size(width, height), rgba_channels());
    for (std::size_t c = 0; c < 3; ++c) std::ranges::fill(image.plane(c), rgb[c]);
    std::ranges::fill(image.plane(3), 1.0f);
    return image;
}

// Blocks of colours with noise, because filters blur noise alone away.
Image random_picture(int width, int height, unsigned seed, float brightest = 1) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    Image image = constant(width, height, {0, 0, 0});
    std::array<std::array<float, 16>, 3> blocks;
    for (auto &channel : blocks)
        for (float &v : channel) v = uniform(generator);
    for (std::size_t c = 0; c < 3; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                image.at(c, x, y) = brightest * (0.8f * blocks[c][std::size_t(x / 9 % 4 + y / 7 % 4 * 4)] +
                                                 0.2f * uniform(generator));
    return image;
}

double flip_of(const Image &a, const Image &b, FlipRange range = FlipRange::ldr) {
    return flip_means(flip_map(a, b, range)).front();
}

PlainRgb plain(const Image &image) {
    PlainRgb rgb{image.windows.width(), image.windows.height(), {}};
    for (std::size_t i = 0; i < image.windows.pixels(); ++i)
        rgb.pixels.emplace_back(image.plane(0)[i], image.plane(1)[i], image.plane(2)[i]);
    return rgb;
}

// Without features and with filters that change nothing, only the colour error remains. Black and white are 100 apart.
TEST(Flip, OfConstantPicturesIsTheDistanceOfTheirColours) {
    const auto expect = [](const std::array<float, 3> &a, const std::array<float, 3> &b, double expected) {
        for (const float value : flip_map(constant(9, 30, a), constant(9, 30, b), FlipRange::ldr))
            ASSERT_NEAR(value, expected, 3e-5); // filters sum in float
    };
    expect({0.25f, 0.5f, 1}, {0.25f, 0.5f, 1}, 0);
    expect({0, 1, 0}, {0, 0, 1}, 1);
    // Their L*, a*, b* by any textbook: 87.735, -86.183, 83.179 and 32.297, 79.188, -107.860; a* and b* times L* / 100.
    const double largest = std::pow(
        87.7347 - 32.2970 +
            std::hypot(-86.1827 * 0.877347 - 79.1875 * 0.322970, 83.1793 * 0.877347 + 107.8602 * 0.322970),
        0.7);
    const double knee = 0.4 * largest;
    expect({0, 0, 0}, {1, 1, 1}, 0.95 + 0.05 * (std::pow(100.0, 0.7) - knee) / (largest - knee));
    const double greys = 116 * (std::cbrt(0.5) - std::cbrt(0.25)); // L* of 0.5 less that of 0.25
    expect({0.25f, 0.25f, 0.25f}, {0.5f, 0.5f, 0.5f}, 0.95 * std::pow(greys, 0.7) / knee);
    expect({-3, 0, 0}, {0, 0, 0}, 0);
    expect({1, 1, 1}, {7, 2, 1.5f}, 0);
}

TEST(Flip, AgreesWithThePaperPixelByPixel) {
    const int width = 33, height = 27;
    const Image a = random_picture(width, height, 1);
    Image b = random_picture(width, height, 2);
    for (std::size_t i = 0; i < b.values.size(); ++i) b.values[i] = 0.8f * a.values[i] + 0.2f * b.values[i];
    const std::vector<float> map = flip_map(a, b, FlipRange::ldr);
    const PlainRgb plain_a = plain(a), plain_b = plain(b);
    for (int y = 0; y < height; y += 2)
        for (int x = 0; x < width; x += 3)
            ASSERT_NEAR(map[std::size_t(y * width + x)], flip_plainly(plain_a, plain_b, x, y), 2e-5)
                << x << " " << y;
}

TEST(Flip, IsTheSameInBothDirectionsAndNoneOfAPictureWithItself) {
    const Image a = random_picture(40, 30, 3), b = random_picture(40, 30, 4);
    EXPECT_EQ(flip_map(a, b, FlipRange::ldr), flip_map(b, a, FlipRange::ldr));
    for (const FlipRange range : {FlipRange::ldr, FlipRange::hdr}) EXPECT_EQ(flip_of(a, a, range), 0);
    for (const float value : flip_map(a, b, FlipRange::hdr)) EXPECT_TRUE(value >= 0 && value <= 1) << value;
}

TEST(Flip, SeesADifferenceOnlyWithinReachOfItsFilters) {
    const Image a = random_picture(64, 40, 5);
    Image b = a;
    b.at(1, 30, 20) += 0.5f;
    const std::vector<float> map = flip_map(b, a, FlipRange::ldr);
    const int reach = std::max(flip_filter_reach(), flip_feature_reach());
    EXPECT_EQ(reach, 10);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 64; ++x) {
            const float value = map[std::size_t(y * 64 + x)];
            const int away = std::max(std::abs(x - 30), std::abs(y - 20));
            EXPECT_TRUE(away <= reach || value == 0) << x << " " << y;
            EXPECT_TRUE(away > 2 || value > 0) << x << " " << y;
        }
}

TEST(Flip, LeavesOutWhatIsNotFinite) {
    Image a = constant(30, 30, {0.5f, 0.5f, 0.5f}), b = constant(30, 30, {0.5f, 0.5f, 0.5f});
    a.at(0, 3, 4) = infinite;
    b.at(2, 20, 9) = std::numeric_limits<float>::quiet_NaN();
    for (const FlipRange range : {FlipRange::ldr, FlipRange::hdr}) {
        const std::vector<float> map = flip_map(a, b, range);
        for (std::size_t i = 0; i < map.size(); ++i) {
            const bool bad = i == 4 * 30 + 3 || i == 9 * 30 + 20;
            EXPECT_TRUE(bad ? std::isnan(map[i]) : map[i] == 0) << i;
        }
    }
    std::vector<std::uint8_t> bits(900);
    bits[0] = bits[4 * 30 + 3] = 1;
    EXPECT_EQ(flip_means(std::vector<float>(900, 0.25f), bits, 2)[1], 0.25);
    EXPECT_TRUE(std::isnan(flip_means(std::vector<float>(900, 0.25f), bits, 2)[2]));
}

// The film curve shows 2.1189 as 0.85.
TEST(Flip, ExposesFromTheBrightestToTheMedian) {
    Image picture = constant(10, 10, {1, 1, 1});
    const double value = 2.118869;
    for (const double exposure : flip_exposures(picture)) EXPECT_NEAR(exposure, value, 1e-5);
    EXPECT_EQ(flip_exposures(picture).size(), 2u);
    for (std::size_t c = 0; c < 3; ++c) picture.plane(c)[7] = 100; // 6.6 stops above
    const std::vector<double> exposures = flip_exposures(picture);
    ASSERT_EQ(exposures.size(), 7u);
    EXPECT_NEAR(exposures.front(), value / 100, 1e-6);
    EXPECT_NEAR(exposures.back(), value, 1e-5);
    EXPECT_NEAR(exposures[3] * exposures[3], exposures[2] * exposures[4], 1e-9);
    EXPECT_TRUE(std::isfinite(flip_exposures(constant(4, 4, {0, 0, 0})).front()));
}

// The exposures are chosen from the reference.
TEST(Flip, OfHighDynamicRangeDoesNotDependOnTheUnitOfLight) {
    Image a = random_picture(40, 30, 6, 20), b = random_picture(40, 30, 7, 20);
    const double flip = flip_of(a, b, FlipRange::hdr);
    for (Image *image : {&a, &b})
        for (float &v : image->values) v *= 1024;
    EXPECT_NEAR(flip_of(a, b, FlipRange::hdr), flip, 1e-6);
    EXPECT_NEAR(flip_of(a, b, FlipRange::ldr), 0, 0.01); // all white
}

} // namespace
} // namespace sparselens
