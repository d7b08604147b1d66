// Motion of textures that were moved by known amounts.
#include "plan/block_motion.h"
#include "support/cloth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace sparselens {
namespace {

struct Shown {
    double grey;
    float z = 5;
};

View view_of(int width, int height, const std::function<Shown(int x, int y)> &shows) {
    const Windows windows = windows_of_size(width, height);
    View view{"x.exr", Image(windows, rgba_channels()), std::vector<float>(windows.pixels())};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Shown shown = shows(x, y);
            for (std::size_t k = 0; k < 4; ++k) view.image.at(k, x, y) = k < 3 ? float(shown.grey) : 1.0f;
            view.z[windows.index(Imath::V2i(x, y))] = shown.z;
        }
    return view;
}

Imath::V2d nothing(const Imath::V2i &) { return {0, 0}; }

TEST(BlockMotion, FindsAShiftedTexture) {
    for (const Imath::V2d &shift : {Imath::V2d(0, 0), {7, -4}, {-13.5, 0.25}}) {
        const View first = view_of(160, 96, [](int x, int y) { return Shown{cloth(x, y)}; });
        const View second =
            view_of(160, 96, [&](int x, int y) { return Shown{cloth(x - shift.x, y - shift.y)}; });
        const auto motions = block_motions(first, second, nothing);
        EXPECT_GE(motions.size(), 100u) << shift;
        Imath::V2d mean(0, 0);
        for (const BlockMotion &block : motions) {
            EXPECT_LT((block.motion - shift).length(), 1) << shift;
            mean += block.motion / double(motions.size());
        }
        EXPECT_LT((mean - shift).length(), 0.2) << shift;
    }
}

// A large picture is searched at a third of its size.
TEST(BlockMotion, FindsLongMotionInLargePictures) {
    const View first = view_of(1440, 168, [](int x, int y) { return Shown{cloth(x / 3.0, y / 3.0)}; });
    const View second =
        view_of(1440, 168, [](int x, int y) { return Shown{cloth((x - 100) / 3.0, y / 3.0)}; });
    const auto motions = block_motions(first, second, nothing);
    EXPECT_GE(motions.size(), 280u);
    for (const BlockMotion &block : motions) {
        EXPECT_NEAR(block.motion.x, 100, 3);
        EXPECT_NEAR(block.motion.y, 0, 3);
        EXPECT_EQ(block.box.max.x - block.box.min.x, 23);
    }
}

TEST(BlockMotion, DoesNotCountWhatHasNoTexture) {
    const View grey = view_of(160, 96, [](int, int) { return Shown{0.3}; });
    EXPECT_TRUE(block_motions(grey, grey, nothing).empty());
    const View ramp = view_of(160, 96, [](int x, int) { return Shown{0.3 + 0.0005 * x}; });
    EXPECT_TRUE(block_motions(ramp, ramp, nothing).empty());
}

// Stripes that move along themselves look the same. Across, they look the same after each period of 12 pixels.
TEST(BlockMotion, MakesNoneUp) {
    const auto stripes = [](int move) {
        return view_of(160, 96, [=](int x, int) { return Shown{(x - move + 120) / 6 % 2 == 0 ? 0.2 : 0.6}; });
    };
    for (const int move : {0, 3, 12, 14})
        for (const BlockMotion &block : block_motions(stripes(0), stripes(move), nothing)) {
            EXPECT_NEAR(block.motion.x, move % 12, 0.3) << move;
            EXPECT_NEAR(block.motion.y, 0, 0.3) << move;
        }
    const auto by_camera = [](const Imath::V2i &) { return Imath::V2d(14, 5); };
    const auto motions = block_motions(stripes(0), stripes(14), by_camera);
    EXPECT_GE(motions.size(), 100u);
    for (const BlockMotion &block : motions) EXPECT_LT((block.motion - Imath::V2d(14, 5)).length(), 0.3);
}

// Along the edges of a picture that is reduced, the least difference lies beside the middle, and yet nothing moves.
TEST(BlockMotion, FindsNoneBetweenCopies) {
    const View still = view_of(1920, 216, [](int x, int y) {
        return Shown{(x / 31 + 2 * (y / 23) + (x * y / 97) % 3) % 5 * 0.15, x / 31 % 2 == 0 ? 4.0f : 9.0f};
    });
    const auto motions = block_motions(still, still, nothing);
    EXPECT_GE(motions.size(), 100u);
    for (const BlockMotion &block : motions) EXPECT_EQ(block.motion, Imath::V2d(0, 0));
}

// A ball moves by 11 pixels behind bars, before a wall of checkers; bars and wall stand still.
TEST(BlockMotion, FindsWhatMovesBehindBars) {
    const auto scene = [](int move) {
        return view_of(240, 144, [=](int x, int y) {
            if (x % 30 < 3) return Shown{0.05, 2};
            const int from_x = x - 100 - move, from_y = y - 70;
            if (from_x * from_x + from_y * from_y < 40 * 40) return Shown{cloth(from_x, from_y), 4};
            return Shown{(x / 5 + y / 5) % 2 == 0 ? 0.2 : 0.6, 9};
        });
    };
    std::size_t moved = 0, still = 0;
    for (const BlockMotion &block : block_motions(scene(0), scene(11), nothing)) {
        const bool moves = block.motion.length() > 1;
        (moves ? moved : still) += 1;
        EXPECT_LT((block.motion - Imath::V2d(moves ? 11 : 0, 0)).length(), 0.5) << block.box.min;
        const Imath::V2i middle = (block.box.min + block.box.max) / 2 - Imath::V2i(100, 70);
        EXPECT_LT(moves ? std::hypot(middle.x, middle.y) : 0, 46) << block.box.min;
    }
    EXPECT_GE(moved, 10u);
    EXPECT_GE(still, 200u);
}

// A block that moves unlike all others may be found in a wrong place.
TEST(BlockMotion, DoesNotBelieveALoneBlock) {
    const auto scene = [](int move) {
        return view_of(160, 96, [=](int x, int y) {
            const int from_x = x - move;
            return from_x >= 80 && from_x < 88 && y >= 40 && y < 48 ? Shown{cloth(2 * from_x, 2 * y), 3}
                                                                    : Shown{cloth(x, y), 9};
        });
    };
    const auto motions = block_motions(scene(0), scene(12), nothing);
    EXPECT_GE(motions.size(), 150u);
    for (const BlockMotion &block : motions) EXPECT_LT(block.motion.length(), 0.5) << block.box.min;
}

TEST(BlockMotion, ComparesWhatBothPicturesHave) {
    const View first = view_of(160, 96, [](int x, int y) { return Shown{cloth(x, y)}; });
    View second = first;
    second.image.windows.display = second.image.windows.data = {{160, 0}, {319, 95}};
    EXPECT_TRUE(block_motions(first, second, nothing).empty());
}

} // namespace
} // namespace sparselens
