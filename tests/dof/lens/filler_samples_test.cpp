// What hides lamps in a picture of one view, in closed form.
#include "dof/lens/blocked_fixture.h"
#include "dof/lens/fillers.h"
#include "dof/lens/lens_gather.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.3, .focal_px = 640, .focus = 6}; // CoC up to 32 px behind focus

// A board at CoC -12 in columns 40 to 45, before a wall at CoC 4 that is `wall` pixels wider on both sides. All around
// is at CoC 24, and so is a lamp in column 30.
Ldi lamp_beside_board(int wall, float light = 900) {
    return make_ldi(windows_of_size(96, 64), rgba_channels(), [&](int x, int y) {
        if (x >= 40 && x < 46) return std::vector<Sample>{{depth_of(lens, -12), {1, 1, 1, 1}}};
        if (x >= 40 - wall && x < 46 + wall) return std::vector<Sample>{{depth_of(lens, 4), {0, 0, 0, 1}}};
        const float grey = x == 30 && y == 32 ? light : 1;
        return std::vector<Sample>{{depth_of(lens, 24), {grey, grey, grey, 1}}};
    });
}

Image picture(const Ldi &ldi, bool one_view) {
    Progress silent;
    return lens_gather(ldi, lens, ldi.windows.data, {.lens_samples = 512, .one_view = one_view}, silent);
}

// The lamp's light in its own row, from one column to another.
double light_in(int from, int to, int wall, bool one_view) {
    const auto row = [&](float light) {
        const Image image = picture(lamp_beside_board(wall, light), one_view);
        double sum = 0;
        for (int x = from; x <= to; ++x) sum += double(image.at(0, x, 32));
        return sum;
    };
    return row(900) - row(1);
}

// Through the lens point u the lamp is at 30.5 + 24 u, and the wall that nobody saw between 40 + 4 u and 46 + 4 u. The
// lamp is there from u = .48 to .77, between columns 42 and 49. The board hides it there up to u = .43 alone.
TEST(HidingFillers, LetNoLampShineWhereNothingWasSeen) {
    const double beside = light_in(7, 32, 8, false), behind = light_in(43, 47, 8, false);
    EXPECT_GT(behind, beside / 10);
    EXPECT_NEAR(light_in(7, 32, 8, true), beside, beside * 1e-4);
    EXPECT_NEAR(light_in(43, 47, 8, true), 0, behind * 1e-3);
}

TEST(HidingFillers, HideNothingElse) {
    const Ldi dark = lamp_beside_board(8, 1);
    EXPECT_EQ(picture(dark, true).values, picture(dark, false).values);
}

TEST(HidingFillers, AreNotThoseOfStrands) {
    const double between = light_in(43, 47, 1, false);
    EXPECT_GT(between, 0);
    EXPECT_NEAR(light_in(43, 47, 1, true), between, between * 1e-4);
}

TEST(HidingFillers, AreNotThoseOfLamps) {
    const Ldi ldi = lamp_beside_board(8);
    const BlockedLdi blocked(ldi, lens);
    const LargeArray<Filler> fillers = find_fillers(ldi, lens, ldi.windows.data);
    const auto hiding = [&](std::span<const std::uint32_t> highlights) {
        return place_hiding_fillers(ldi, lens, fillers, blocked.samples, highlights).count();
    };
    constexpr int rows = 10, board = 6;
    std::vector<std::uint32_t> wall;
    for (int y = 0; y < rows; ++y) {
        for (const std::size_t pixel : {ldi.windows.index(39, y), ldi.windows.index(46, y)})
            wall.push_back(place_of(blocked.samples, ldi, pixel, ldi.pixel(pixel).front()));
    }
    std::ranges::sort(wall);
    EXPECT_EQ(hiding({}) - hiding(wall), rows * board);
}

} // namespace
} // namespace sparselens
