#include "base/image.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const std::vector<Channel> two{{"R", PixelType::half}, {"Z", PixelType::float32}};

TEST(Windows, OfASizeStartAtTheOriginAndAreInclusive) {
    const Windows w = windows_of_size(3, 2);
    EXPECT_EQ(w.data, w.display);
    EXPECT_EQ(w.data, Imath::Box2i({0, 0}, {2, 1}));
    EXPECT_EQ(w.width(), 3);
    EXPECT_EQ(w.height(), 2);
    EXPECT_EQ(w.pixels(), 6u);
    EXPECT_EQ(w.pixel_aspect, 1);
}

TEST(Windows, PixelsAreCountedWithoutOverflow) {
    const Windows w = windows_of_size(100'000, 100'000);
    EXPECT_EQ(w.pixels(), 10'000'000'000u);
}

TEST(Windows, DisplaySizeIsNotTheDataSize) {
    const Windows w{Imath::Box2i({-1, -2}, {8, 2}), Imath::Box2i({0, 0}, {0, 0})};
    EXPECT_EQ(w.display_width(), 10);
    EXPECT_EQ(w.display_height(), 5);
    EXPECT_EQ(w.pixels(), 1u);
}

TEST(Image, StartsBlackAndPlanesFollowEachOther) {
    Image image(windows_of_size(3, 2), two);
    EXPECT_EQ(image.values, LargeArray<float>(12, 0.0f));
    image.plane(1)[4] = 7;
    EXPECT_EQ(image.values[6 + 4], 7);
    EXPECT_EQ(image.plane(0).size(), 6u);
}

TEST(Image, PixelCoordinatesAreOfTheDataWindow) {
    Image image({Imath::Box2i({0, 0}, {9, 9}), Imath::Box2i({-5, -7}, {-3, -6})}, two);
    image.at(1, -4, -6) = 3;
    EXPECT_EQ(image.plane(1)[1 * 3 + 1], 3);
    image.at(0, -5, -7) = 2;
    EXPECT_EQ(image.plane(0)[0], 2);
    EXPECT_EQ(std::as_const(image).at(0, -5, -7), 2);
}

TEST(Image, ChannelsAreFoundByTheirFullName) {
    const std::vector<Channel> channels{{"R"}, {"diffuse.R"}, {"Z", PixelType::float32}};
    EXPECT_EQ(find_channel(channels, "diffuse.R"), 1u);
    EXPECT_EQ(find_channel(channels, "Z"), 2u);
    EXPECT_EQ(find_channel(channels, "diffuse"), npos);
    EXPECT_EQ(find_channel(channels, "r"), npos);
    EXPECT_EQ(find_channel({}, "R"), npos);
}

TEST(Image, ColoursAreFoundWhereverTheyAre) {
    const auto found = find_rgb(std::vector<Channel>{{"A"}, {"B"}, {"diffuse.R"}, {"G"}, {"R"}});
    EXPECT_EQ(found, (std::array<std::size_t, 3>{4, 3, 1}));
    EXPECT_TRUE(all_found(found));
    const auto red_and_blue = find_rgb(std::vector<Channel>{{"R"}, {"B"}});
    EXPECT_EQ(red_and_blue, (std::array<std::size_t, 3>{0, npos, 1}));
    EXPECT_FALSE(all_found(red_and_blue));
}

TEST(Image, RgbaIsHalf) {
    const auto channels = rgba_channels();
    ASSERT_EQ(channels.size(), 4u);
    EXPECT_EQ(channels[3], (Channel{"A", PixelType::half}));
}

} // namespace
} // namespace sparselens
