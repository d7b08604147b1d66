#include "base/subpixels.h"
#include "support/all_channels.h"

#include <gtest/gtest.h>

#include <limits>

namespace sparselens {
namespace {

const PixelFilter wide{PixelFilter::Shape::blackman_harris, 1.5};

// Exactly, because the shares add up to 1, also where the border cuts the filter off.
TEST(Subpixels, WhatIsConstantStaysSo) {
    for (const int across : {2, 3, 4, 16})
        for (const PixelFilter &filter : {PixelFilter{}, wide}) {
            const Imath::Box2i data({-1, -5}, {16 * across, 4 * across});
            const Image fine = filled(windows_of(data, data), {{"R"}, {"A"}},
                                      [](std::size_t k, int, int) { return k == 0 ? 0.3f : 1.0f; });
            const Image out = mean_of_subpixels(fine, {across, filter}, reduced(data, across));
            for (const float value : out.plane(0)) EXPECT_EQ(value, 0.3f);
            for (const float value : out.plane(1)) EXPECT_EQ(value, 1);
        }
}

// Each pixel replaces a number of sub-pixels, so the sum over the picture is smaller by that factor. A filter only
// moves light.
TEST(Subpixels, LightIsKept) {
    for (const int across : {2, 3, 5})
        for (const PixelFilter &filter : {PixelFilter{}, wide}) {
            const Imath::Box2i data({0, 0}, {20 * across - 1, 20 * across - 1});
            const Imath::Box2i lit({8 * across, 8 * across}, {12 * across - 2, 12 * across});
            const Image fine = filled(windows_of(data, data), {{"R"}}, [&](std::size_t, int x, int y) {
                return lit.intersects(Imath::V2i(x, y)) ? float(x % 7 + y) : 0;
            });
            const Image out = mean_of_subpixels(fine, {across, filter}, reduced(data, across));
            double before = 0, after = 0;
            for (const float value : fine.values) before += double(value);
            for (const float value : out.values) after += double(value);
            EXPECT_NEAR(after * across * across / before, 1, 1e-6);
        }
}

// An element that begins and ends within pixels of its display window: its missing sub-pixels are empty, and a wide
// filter carries light into neighbouring pixels. Beyond the display window the content is unknown.
TEST(Subpixels, WhatIsNotThereIsEmpty) {
    const Imath::Box2i display({0, 0}, {79, 79}), data({21, 21}, {45, 52});
    std::vector<Channel> channels{{"A"}, {"N.X"}};
    find_kinds(channels);
    const Image fine = filled(windows_of(display, data), channels, [](std::size_t, int, int) { return 1; });
    for (const PixelFilter &filter : {PixelFilter{}, wide}) {
        const Subpixels by{4, filter};
        const Image out = mean_of_subpixels(fine, by, pixels_reached(data, by), 7);
        double covered = 0;
        for (const float a : out.plane(0)) covered += double(a);
        EXPECT_NEAR(covered * 16 / (25 * 32), 1, 1e-6);
        if (filter == wide) continue;
        EXPECT_EQ(out.windows.data, Imath::Box2i({5, 5}, {11, 13}));
        EXPECT_FLOAT_EQ(out.at(0, 5, 8), 0.75f);
        EXPECT_FLOAT_EQ(out.at(0, 5, 5), 0.75f * 0.75f);
        EXPECT_FLOAT_EQ(out.at(0, 11, 13), 0.5f * 0.25f);
        EXPECT_EQ(out.at(1, 5, 5), 1);
        EXPECT_EQ(out.at(1, 11, 13), 7);
    }
    const Image beyond =
        mean_of_subpixels(filled(windows_of(data, data), channels, [](std::size_t, int, int) { return 1; }),
                          {4, wide}, {{5, 5}, {11, 13}}, 7);
    for (const float value : beyond.values) EXPECT_EQ(value, 1);
}

// A pixel's value does not depend on which others are computed, as long as its sub-pixels are there.
TEST(Subpixels, OfAPartOfThePictureAreTheSame) {
    const Imath::Box2i data({0, 0}, {39, 39}), part({5, 6}, {9, 7});
    const Image fine = random_picture(windows_of(data, data));
    for (const PixelFilter &filter : {PixelFilter{}, wide}) {
        const Subpixels by{2, filter};
        const Image all = mean_of_subpixels(fine, by, reduced(data, 2));
        const Image some = mean_of_subpixels(crop(fine, subpixels_under(part, by)), by, part);
        EXPECT_EQ(some.values, crop(all, part).values);
    }
}

TEST(Subpixels, OfABoxAndBack) {
    const Imath::Box2i box({-2, 3}, {4, 5});
    for (const int across : {1, 2, 3}) {
        EXPECT_EQ(reduced(subpixels_in(box, across), across), box);
        EXPECT_TRUE(subpixels_in({{-2, 3}, {-2, 3}}, across).intersects(middle_subpixel({-2, 3}, across)));
    }
    EXPECT_EQ(subpixels_in(box, 2), Imath::Box2i({-4, 6}, {9, 11}));
    EXPECT_EQ(subpixels_under(box, {2, wide}), Imath::Box2i({-5, 5}, {10, 12}));
    EXPECT_EQ(pixels_reached(subpixels_in(box, 2), {2, {}}), box);
    EXPECT_EQ(pixels_reached(subpixels_in(box, 2), {2, wide}), Imath::Box2i({-3, 2}, {5, 6}));
    constexpr int far = 1 << 28; // times 16 it overflows to 0
    EXPECT_EQ(middle_subpixel({far, -far}, 16),
              Imath::V2i(std::numeric_limits<int>::max(), std::numeric_limits<int>::min()));
}

} // namespace
} // namespace sparselens
