#include "shutter/shutter_mean.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>

namespace sparselens {
namespace {

float hashed(std::uint32_t id) { return std::bit_cast<float>(0x3f800000u + id); }

std::vector<Channel> channels() {
    std::vector<Channel> all{{"R"}, {"A"}, {"objectid.X", PixelType::uint32}, {"P.Z", PixelType::float32}};
    for (const char *name : {"crypto00.R", "crypto00.G", "crypto00.B", "crypto00.A"})
        all.push_back({name, PixelType::float32});
    find_kinds(all);
    return all;
}

// A pixel of 4 x 1 of each value, at x.
Image picture(int x, const std::vector<float> &values) {
    Windows windows = windows_of_size(4, 1);
    windows.data = {{x, 0}, {x, 0}};
    Image image(windows, channels());
    for (std::size_t k = 0; k < values.size(); ++k) image.at(k, x, 0) = values[k];
    return image;
}

const std::vector<float> first{1, 1, hashed(1), 2, hashed(1), 0.75f, hashed(2), 0.25f},
    other{0.5f, 0.5f, hashed(2), 4, hashed(2), 0.375f, hashed(3), 0.125f};

TEST(ShutterMean, OfOnePictureIsThePicture) {
    ShutterMean mean;
    mean.add(picture(1, first), std::array{0.5}, true);
    const Image image = mean.take();
    EXPECT_EQ(image.windows, picture(1, first).windows);
    for (std::size_t k = 0; k < first.size(); ++k)
        EXPECT_EQ(std::bit_cast<std::uint32_t>(image.at(k, 1, 0)), std::bit_cast<std::uint32_t>(first[k]))
            << k;
}

TEST(ShutterMean, AveragesLightAndDataAndTakesIdsFromTheMiddle) {
    for (const bool middle_first : {true, false}) {
        ShutterMean mean;
        mean.add(picture(1, first), std::array{1.0}, middle_first);
        mean.add(picture(1, other), std::array{3.0}, !middle_first);
        const Image image = mean.take();
        EXPECT_FLOAT_EQ(image.at(0, 1, 0), (1 + 3 * 0.5f) / 4);
        EXPECT_FLOAT_EQ(image.at(1, 1, 0), (1 + 3 * 0.5f) / 4);
        EXPECT_EQ(image.at(2, 1, 0), hashed(middle_first ? 1 : 2));
        EXPECT_FLOAT_EQ(image.at(3, 1, 0), (2 + 3 * 4.0f) / 4);
    }
}

// Ids 1, 2, 3 cover 0.75/4, (0.25 + 3 * 0.375)/4, 3 * 0.125/4: the two largest stay.
TEST(ShutterMean, RanksTheIdsOfAMatteAnew) {
    ShutterMean mean;
    mean.add(picture(1, first), std::array{1.0}, true);
    mean.add(picture(1, other), std::array{3.0}, false);
    const Image image = mean.take();
    EXPECT_EQ(image.at(4, 1, 0), hashed(2));
    EXPECT_FLOAT_EQ(image.at(5, 1, 0), 1.375f / 4);
    EXPECT_EQ(image.at(6, 1, 0), hashed(1));
    EXPECT_FLOAT_EQ(image.at(7, 1, 0), 0.75f / 4);
}

TEST(ShutterMean, IsEmptyWhereAMomentHasNoPixels) {
    ShutterMean mean;
    mean.add(picture(2, first), std::array{1.0}, true);
    mean.add(picture(0, other), std::array{1.0}, false);
    const Image image = mean.take();
    EXPECT_EQ(image.windows.data, Imath::Box2i({0, 0}, {2, 0}));
    EXPECT_EQ(image.at(1, 0, 0), 0.25f);
    EXPECT_EQ(image.at(1, 1, 0), 0);
    EXPECT_EQ(image.at(1, 2, 0), 0.5f);
    EXPECT_EQ(image.at(2, 2, 0), hashed(1));
    EXPECT_EQ(image.at(4, 0, 0), hashed(2));
    EXPECT_FLOAT_EQ(image.at(5, 0, 0), 0.1875f);
    EXPECT_EQ(image.at(4, 2, 0), hashed(1));
    EXPECT_FLOAT_EQ(image.at(5, 2, 0), 0.375f);
}

// Each row has its own weights; rows beyond the display window have those of its first or last row.
TEST(ShutterMean, WeighsEachRowByItself) {
    Windows windows = windows_of_size(1, 2);
    windows.data = {{0, -1}, {0, 3}};
    const auto column = [&](const std::vector<float> &values) {
        Image image(windows, channels());
        for (int y = -1; y <= 3; ++y)
            for (std::size_t k = 0; k < values.size(); ++k) image.at(k, 0, y) = values[k];
        return image;
    };
    ShutterMean mean;
    mean.add(column(first), std::array{1.0, 0.0}, true);
    mean.add(column(other), std::array{3.0, 0.25}, false);
    const Image image = mean.take();
    for (const int y : {-1, 0}) {
        EXPECT_FLOAT_EQ(image.at(0, 0, y), (1 + 3 * 0.5f) / 4) << y;
        EXPECT_FLOAT_EQ(image.at(5, 0, y), (0.25f + 3 * 0.375f) / 4) << y;
    }
    for (const int y : {1, 2, 3}) {
        EXPECT_EQ(image.at(0, 0, y), 0.5f) << y;
        EXPECT_EQ(image.at(2, 0, y), hashed(1)) << y; // of the middle moment, though it has no weight here
        EXPECT_EQ(image.at(4, 0, y), hashed(2)) << y;
        EXPECT_EQ(image.at(5, 0, y), 0.375f) << y;
    }
}

// Whatever the weights: sums of ones are rounded as the sum of weights is.
TEST(ShutterMean, KeepsACoverageOfOne) {
    ShutterMean mean;
    for (int m = 0; m < 7; ++m) mean.add(picture(1, first), std::array{0.1 + 0.01 * m}, m == 3);
    EXPECT_EQ(mean.take().at(1, 1, 0), 1);
}

} // namespace
} // namespace sparselens
