#include "base/subpixels.h"
#include "deep/flatten.h"
#include "deep/proxy.h"
#include "support/lens_ldi.h"
#include "support/order.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

Windows moved(int x, int y, int width, int height) {
    Windows w = windows_of_size(width, height);
    w.data = Imath::Box2i({x, y}, {x + width - 1, y + height - 1});
    return w;
}

TEST(Reduced, RoundsDownOnBothSidesOfZero) {
    EXPECT_EQ(reduced(Imath::Box2i({0, 0}, {9, 8}), 2), Imath::Box2i({0, 0}, {4, 4}));
    EXPECT_EQ(reduced(Imath::Box2i({-3, -4}, {5, 3}), 3), Imath::Box2i({-1, -2}, {1, 1}));
    EXPECT_EQ(reduced(Imath::Box2i({-3, -4}, {5, 3}), 1), Imath::Box2i({-3, -4}, {5, 3}));
}

TEST(Padded, LeavesThePictureWhereItIs) {
    const Ldi ldi = random_surfaces(moved(3, -2, 7, 5), lens, false, 1);
    const Ldi out = padded(ldi, Imath::Box2i({1, -3}, {12, 2}));
    EXPECT_EQ(out.windows.data, Imath::Box2i({1, -3}, {12, 2}));
    const Image flat = flatten(out);
    EXPECT_EQ(crop(flat, ldi.windows.data).values, flatten(ldi).values);
    for (std::size_t k = 0; k < flat.channels.size(); ++k) {
        EXPECT_EQ(flat.at(k, 1, -3), 0);
        EXPECT_EQ(flat.at(k, 12, 0), 0);
    }
}

// The mean of the pixels that become one; empty beyond the data window.
double box_mean(const Image &image, std::size_t channel, int x, int y, int factor) {
    double sum = 0;
    for (int v = y * factor; v < (y + 1) * factor; ++v)
        for (int u = x * factor; u < (x + 1) * factor; ++u)
            if (image.windows.data.intersects(Imath::V2i(u, v))) sum += double(image.at(channel, u, v));
    return sum / (factor * factor);
}

TEST(Proxy, FlattensToTheMean) {
    for (const bool opaque : {true, false})
        for (const int factor : {1, 2, 3, 5}) {
            const Ldi ldi = random_surfaces(moved(-4, 3, 23, 17), lens, opaque, 9);
            const Ldi out = proxy(ldi, factor);
            EXPECT_TRUE(order_of(out).sorted && order_of(out).apart);
            EXPECT_EQ(out.windows.data, reduced(ldi.windows.data, factor));
            const Image large = flatten(ldi), small = flatten(out);
            const Imath::Box2i &data = small.windows.data;
            for (std::size_t k = 0; k < ldi.channels.size(); ++k)
                for (int y = data.min.y; y <= data.max.y; ++y)
                    for (int x = data.min.x; x <= data.max.x; ++x)
                        EXPECT_NEAR(small.at(k, x, y), box_mean(large, k, x, y, factor), 2e-4)
                            << ldi.channels[k].name << " " << x << "," << y << " by " << factor;
        }
}

TEST(Proxy, KeepsWhatIsHidden) {
    // A wall behind a card that hides all of it: the proxy keeps both.
    const Ldi ldi = make_ldi(windows_of_size(4, 4), rgba_channels(), [](int, int) {
        return std::vector<Sample>{{2, {1, 0, 0, 1}}, {8, {0, 0.5f, 0, 1}}};
    });
    const Ldi out = proxy(ldi, 2);
    ASSERT_EQ(out.samples(), 8u);
    EXPECT_EQ(out.z[1], 8);
    EXPECT_NEAR(out.values[1][1], 0.5f, 1e-6);
    EXPECT_NEAR(out.values[3][1], 1, 1e-6);
    EXPECT_NEAR(out.dx[0], 0, 1e-6);
}

// With a lens, samples that it moves apart by at most the tolerance become one surface, at the mean of their inverse
// depths. The light of a sample may be dimmed, but not its coverage.
TEST(Proxy, IsMadeForALens) {
    const double scale = lens.radius * lens.focal_px;
    const auto made = [&](double apart) {
        const Ldi ldi = make_ldi(windows_of_size(2, 2), rgba_channels(), [&](int x, int) {
            return std::vector<Sample>{{scale / (8 - apart * x), {1, 1, 1, 1}}};
        });
        const std::vector<float> left{1, 0.5f, 1, 0.5f};
        return proxy(ldi, 2, {.scale = scale, .tolerance = 1, .left = left});
    };
    const Ldi one = made(0.9), two = made(1.1);
    ASSERT_EQ(one.samples(), 1u);
    EXPECT_NEAR(scale / double(one.z[0]), 8 - 0.45, 1e-5);
    EXPECT_NEAR(one.values[0][0], 0.75f, 1e-6);
    EXPECT_EQ(one.values[3][0], 1);
    ASSERT_EQ(two.samples(), 2u);
    EXPECT_NEAR(two.values[0][0] + (1 - two.values[3][0]) * two.values[0][1], 0.75f, 1e-6);
}

// Joined samples form one surface, at the mean of its inverse depths, even with another surface between its samples;
// and the picture stays the mean of the large one.
TEST(Proxy, KeepsTogetherWhatIsJoined) {
    const double scale = lens.radius * lens.focal_px;
    const Ldi ldi = make_ldi(windows_of_size(2, 2), rgba_channels(), [&](int x, int y) {
        return std::vector<Sample>{
            {scale / (2 * y + x == 3 ? 16.0 : 20 - 6.0 * (2 * y + x)), {float(y), 1, 1, 1}}};
    });
    const std::vector<std::uint32_t> joined{0, 0, 0, 3};
    const Ldi out = proxy(ldi, 2, {.scale = scale, .tolerance = 1, .joined = joined});
    ASSERT_EQ(out.samples(), 2u);
    EXPECT_NEAR(scale / double(out.z[0]), 16, 1e-5);
    EXPECT_NEAR(scale / double(out.z[1]), 14, 1e-5);
    EXPECT_NEAR(out.values[3][1], 1, 1e-6);
    EXPECT_NEAR(flatten(out).at(0, 0, 0), 0.5, 1e-3);
}

// A pixel of CoC -3.5 and 2, one of CoC 0.9 and a sharp one, 20 pixels apart: each spreads by its own CoC.
TEST(ReachedDisplay, IsWhatEachSampleIsSpreadOver) {
    Windows windows = moved(30, 10, 41, 1);
    windows.display = Imath::Box2i({0, 0}, {99, 12});
    const auto columns = [&](double left, double middle, double right) {
        return make_ldi(windows, rgba_channels(), [&](int x, int) {
            std::vector<Sample> samples;
            if (x == 30)
                samples = {{depth_of(lens, left), {1, 1, 1, 0.5f}}, {depth_of(lens, 2), {1, 1, 1, 1}}};
            if (x == 50) samples = {{depth_of(lens, middle), {1, 1, 1, 1}}};
            if (x == 70) samples = {{depth_of(lens, right), {1, 1, 1, 1}}};
            return samples;
        });
    };
    EXPECT_EQ(reached_display(columns(-3.5, 0.9, 0.4), lens), Imath::Box2i({25, 5}, {52, 12}));
    EXPECT_EQ(reached_display(columns(-3.5, 0.9, 1.5), lens), Imath::Box2i({25, 5}, {73, 12}));
    EXPECT_EQ(reached_display(columns(-60, 0.9, 0.4), lens),
              Imath::Box2i({0, 0}, {91, 12})); // and no farther
    const Ldi sharp = make_ldi(windows, rgba_channels(), [](int, int) {
        return std::vector<Sample>{{5, {1, 1, 1, 1}}};
    });
    EXPECT_TRUE(reached_display(sharp, lens).isEmpty());
}

TEST(Proxy, UnlikeImagesStayApart) {
    const auto samples = [](double image_z) {
        const Ldi ldi = make_ldi(windows_of_size(2, 2), {{"R"}, {"A"}}, [&](int x, int) {
            Sample s{x == 0 ? 2 : 2.001, {1, 1}};
            s.image_z = x == 0 ? 9 : image_z;
            return std::vector<Sample>{s};
        });
        return proxy(ldi, 2).samples();
    };
    EXPECT_EQ(samples(9.1), 1u);
    EXPECT_GT(samples(20), 1u);
    EXPECT_GT(samples(-9), 1u);
}

} // namespace
} // namespace sparselens
