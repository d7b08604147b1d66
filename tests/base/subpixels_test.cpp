#include "base/random.h"
#include "base/subpixels.h"
#include "dof/reference/subpixels_slowly.h"

#include <gtest/gtest.h>

#include <bit>
#include <functional>

namespace sparselens {
namespace {

using Shape = PixelFilter::Shape;
const PixelFilter wide{Shape::blackman_harris, 1.5};

Windows windows_of(const Imath::Box2i &display, const Imath::Box2i &data) { return {display, data, 1}; }

// Colours, coverage, data, ids of two kinds and a matte.
std::vector<Channel> all_channels() {
    std::vector<Channel> channels{{"R"}, {"A"}, {"N.X"}, {"N.Y"}, {"id", PixelType::uint32}, {"IndexOB"}};
    for (const char *name : {"CryptoObject00.R", "CryptoObject00.G", "CryptoObject00.B", "CryptoObject00.A"})
        channels.push_back({name, PixelType::float32});
    find_kinds(channels);
    return channels;
}

Image filled(const Windows &windows, const std::vector<Channel> &channels,
             const std::function<float(std::size_t k, int x, int y)> &value) {
    Image image(windows, channels);
    const Imath::Box2i &data = windows.data;
    for (std::size_t k = 0; k < channels.size(); ++k)
        for (int y = data.min.y; y <= data.max.y; ++y)
            for (int x = data.min.x; x <= data.max.x; ++x) image.at(k, x, y) = value(k, x, y);
    return image;
}

// Whole numbers as ids, of which there are few.
Image random_picture(const Windows &windows) {
    std::vector<Channel> channels = all_channels();
    return filled(windows, channels, [&](std::size_t k, int x, int y) {
        const std::uint32_t bits = mix_bits(std::uint32_t(k), mix_bits(std::uint32_t(x), std::uint32_t(y)));
        const float share = float(bits >> 8) / 0x1p24f;
        if (channels[k].kind == ChannelKind::matte_id) return float(1 + bits % 3);
        if (channels[k].kind == ChannelKind::matte_coverage) return share / 2;
        return holds_ids(channels[k]) ? std::bit_cast<float>(bits % 5) : share;
    });
}

// Also where the data window begins within a block, and ends within one.
TEST(Subpixels, AreAsTheReferenceHasThem) {
    for (const int across : {1, 2, 3, 4})
        for (const PixelFilter &filter : {PixelFilter{}, wide, PixelFilter{Shape::gaussian, 3}}) {
            const Imath::Box2i display({0, 0}, {12 * across - 1, 9 * across - 1});
            for (const Imath::Box2i &data :
                 {display, Imath::Box2i({-7, -3}, {11 * across, 10 * across + 1})}) {
                const Image fine = random_picture(windows_of(display, data));
                const Imath::Box2i box({2, 1}, {8, 7});
                const Subpixels by{across, filter};
                const Image fast = mean_of_subpixels(fine, by, box),
                            slow = mean_of_subpixels_slowly(fine, by, box);
                ASSERT_EQ(fast.windows, slow.windows);
                for (std::size_t i = 0; i < fast.values.size(); ++i) {
                    const Channel &channel = fast.channels[i / fast.windows.pixels()];
                    if (is_light(channel) || channel.kind == ChannelKind::matte_coverage)
                        ASSERT_NEAR(fast.values[i], slow.values[i], 1e-6) << channel.name;
                    else
                        ASSERT_EQ(std::bit_cast<std::uint32_t>(fast.values[i]),
                                  std::bit_cast<std::uint32_t>(slow.values[i]))
                            << channel.name;
                }
            }
        }
}

// Exactly, as the shares add up to 1, also where the border cuts the filter off.
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

// Each pixel is a number of sub-pixels: the sum over the picture is as much smaller. A filter only moves light.
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

// What a pixel is does not depend on which others are made, as long as the sub-pixels under it are there.
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
}

} // namespace
} // namespace sparselens
