#include "plan/block_motion.h"
#include "support/cloth.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>

namespace sparselens {
namespace {

constexpr ThinLens lens{.radius = 0.1, .focal_px = 160, .focus = 5};

View texture(double moved, float z, double contrast = 1) {
    const Windows windows = windows_of_size(160, 96);
    View view{"x.exr", Image(windows, rgba_channels()), std::vector<float>(windows.pixels(), z)};
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 160; ++x)
            for (std::size_t k = 0; k < 3; ++k)
                view.image.at(k, x, y) = float(contrast * cloth(x - moved, y));
    return view;
}

std::optional<MomentsNeed> needed(double moved, float z, double part = 1, int across = 1) {
    const auto expected = [](const Imath::V2i &) { return Imath::V2d(0); };
    return moments_needed(texture(0, z), texture(moved, z), lens, expected, part, across);
}

// In focus, steps of 2 pixels do not show.
TEST(MomentsNeeded, FollowTheMotionInFocus) {
    EXPECT_EQ(needed(0, 5)->moments, 1);
    EXPECT_NEAR(needed(0, 5)->motion, 0, 0.2);
    EXPECT_EQ(needed(1.5, 5)->moments, 1);
    EXPECT_EQ(needed(5, 5)->moments, 3);
    EXPECT_NEAR(needed(5, 5)->motion, 5, 0.2);
}

TEST(MomentsNeeded, AreFewerOutOfFocus) {
    const double coc = circle_of_confusion(lens, 2); // -4.8 pixels
    EXPECT_NEAR(longest_step(coc), 2 + 0.75 * 4.8, 1e-9);
    EXPECT_EQ(longest_step(-coc), longest_step(coc));
    EXPECT_EQ(needed(5, 2)->moments, 1);
    EXPECT_EQ(needed(5, 2, 0.5)->moments, 2);
    EXPECT_EQ(needed(5, std::numeric_limits<float>::infinity(), 0.5)->moments, 3); // 10 / (2 + 0.75 * 3.2)
}

// The pictures may be of times that lie closer together than the shutter is open, and have sub-pixels.
TEST(MomentsNeeded, AreOfTheWholeShutterAndOfThePicture) {
    EXPECT_NEAR(needed(5, 5, 0.25)->motion, 20, 0.8);
    EXPECT_EQ(needed(4.6, 5, 0.25)->moments, 10);
    EXPECT_NEAR(needed(5, 5, 0.25, 2)->motion, 10, 0.4);
    EXPECT_EQ(needed(4.6, 5, 0.25, 2)->moments, 5);
}

TEST(MomentsNeeded, AreUnknownWithoutTexture) {
    const auto expected = [](const Imath::V2i &) { return Imath::V2d(3, 0); };
    EXPECT_FALSE(moments_needed(texture(0, 5, 0), texture(0, 5, 0), lens, expected, 1));
}

} // namespace
} // namespace sparselens
