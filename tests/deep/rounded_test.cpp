#include "base/channel_kind.h"
#include "deep/rounded.h"
#include "deep/tidy.h"
#include "lens/thin_lens.h"
#include "support/lens_ldi.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr double scale = 38.4; // pixels times scene units

// Pixels of one sample each.
Ldi depths_of_all_sizes() {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> exponent(-6, 20);
    Ldi ldi;
    ldi.windows = windows_of_size(2000, 1);
    for (std::uint64_t i = 0; i <= 2000; ++i) ldi.begin.push_back(i);
    for (int n = 0; n < 1000; ++n) {
        const float z = std::exp2(exponent(random));
        ldi.z.insert(ldi.z.end(), {z, std::nextafter(z, inf)});
    }
    std::ranges::sort(ldi.z);
    ldi.z.back() = inf;
    return ldi;
}

TEST(RoundForLens, DepthsMoveByA64thOfAPixelAtMostAndKeepTheirOrder) {
    const Ldi before = depths_of_all_sizes();
    Ldi after = before;
    round_for_lens(after, scale);
    int moved = 0;
    for (std::size_t i = 0; i < before.samples(); ++i) {
        EXPECT_LE(std::abs(scale / double(after.z[i]) - scale / double(before.z[i])), (1.0 + 1e-6) / 64)
            << before.z[i];
        moved += after.z[i] != before.z[i];
    }
    EXPECT_GT(moved, 1500);
    EXPECT_TRUE(std::ranges::is_sorted(after.z));
    EXPECT_EQ(after.z.back(), inf);
}

TEST(RoundForLens, KeepsAPixelTidyWhoseSamplesLieSideBySide) {
    for (const bool volumes : {false, true}) {
        Ldi ldi = depths_of_all_sizes();
        ldi.windows = windows_of_size(2, 1);
        ldi.begin = {0, 1999, 2000};
        if (volumes) ldi.z_back = ldi.z;
        ASSERT_TRUE(order_of(ldi).sorted && order_of(ldi).apart);
        const Ldi before = ldi;
        round_for_lens(ldi, scale);
        EXPECT_TRUE(order_of(ldi).sorted && order_of(ldi).apart);
        EXPECT_EQ(ldi.z, before.z); // only whole pixels, and the second sample is infinite
    }
}

TEST(RoundForLens, IsWithinWhatItSays) {
    const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};
    const Ldi before = random_surfaces(windows_of_size(40, 30), lens, false, 4);
    Ldi after = before;
    round_for_lens(after, perceptive_depth(lens, 1));
    for (std::size_t i = 0; i < before.samples(); ++i) {
        for (const auto &[was, is] :
             {std::pair(before.dx[i], after.dx[i]), std::pair(before.dy[i], after.dy[i])}) {
            EXPECT_LE(std::abs(is - was), 1.0f / 128);
            EXPECT_EQ(is * 64, std::nearbyint(is * 64));
        }
        for (std::size_t k = 0; k < before.channels.size(); ++k) {
            const float was = before.values[k][i], is = after.values[k][i];
            if (before.channels[k].name == "A")
                EXPECT_EQ(is, was);
            else
                EXPECT_LE(std::abs(is - was), std::abs(was) / 512);
        }
    }
    EXPECT_NE(after.values, before.values);
    Ldi again = after;
    round_for_lens(again, perceptive_depth(lens, 1));
    EXPECT_EQ(again.values, after.values);
    EXPECT_EQ(again.z, after.z);
    EXPECT_NE(after.z, before.z);
    EXPECT_EQ(order_of(after).sorted, order_of(before).sorted);
    EXPECT_EQ(order_of(after).apart, order_of(before).apart);
}

TEST(RoundForLens, CountsPixelsOfThePicture) {
    WarpOptions lens;
    lens.radius = 0.06;
    lens.focal_px = 1280;
    EXPECT_DOUBLE_EQ(scale_in_picture(lens), 0.06 * 1280);
    lens.across = 2;
    EXPECT_DOUBLE_EQ(scale_in_picture(lens), 0.06 * 640);
}

TEST(RoundForLens, LeavesDataAndIdsAndWithoutALensDepths) {
    Ldi ldi = depths_of_all_sizes();
    ldi.channels = {
        {"R"}, {"N.X", PixelType::float32}, {"crypto00.R", PixelType::float32}, {"id", PixelType::uint32}};
    find_kinds(ldi.channels);
    ldi.values.assign(4, std::vector<float>(ldi.samples(), 0.123456789f));
    const Ldi before = ldi;
    round_for_lens(ldi, 0);
    EXPECT_EQ(ldi.z, before.z);
    EXPECT_NE(ldi.values[0], before.values[0]);
    for (const std::size_t k : {std::size_t{1}, std::size_t{2}, std::size_t{3}})
        EXPECT_EQ(ldi.values[k], before.values[k]) << ldi.channels[k].name;
}

} // namespace
} // namespace sparselens
