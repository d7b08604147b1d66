// What hides lamps where no view looked, in closed form.
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

Image picture(const Ldi &ldi) {
    Progress silent;
    return lens_gather(ldi, lens, ldi.windows.data, {.lens_samples = 512}, silent);
}

// The lamp's light in its own row, from one column to another.
double light_in(int from, int to, int wall) {
    const auto row = [&](float light) {
        const Image image = picture(lamp_beside_board(wall, light));
        double sum = 0;
        for (int x = from; x <= to; ++x) sum += double(image.at(0, x, 32));
        return sum;
    };
    return row(900) - row(1);
}

// Through the lens point u the lamp is at 30.5 + 24 u, and the wall that nobody saw between 40 + 4 u and 46 + 4 u. The
// lamp is there from u = .48 to .77, between columns 42 and 49. The board hides it there up to u = .43 alone.
TEST(HidingFillers, LetNoLampShineWhereNothingWasSeen) {
    EXPECT_NEAR(light_in(43, 47, 8), 0, light_in(7, 32, 8) * 1e-4);
}

TEST(HidingFillers, AreNotThoseOfStrands) { EXPECT_GT(light_in(43, 47, 1), light_in(7, 32, 1) / 10); }

// The lamp's disc ends above row 7.
TEST(HidingFillers, HideNothingElse) {
    const Image lit = picture(lamp_beside_board(8)), dark = picture(lamp_beside_board(8, 1));
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 96; ++x) EXPECT_EQ(lit.at(0, x, y), dark.at(0, x, y)) << x << ' ' << y;
}

TEST(HidingFillers, AreNotThoseOfLamps) {
    const Ldi ldi = lamp_beside_board(8);
    const BlockedLdi blocked(ldi, lens);
    const LargeArray<Filler> fillers = find_fillers(ldi, lens, ldi.windows.data);
    const auto hiding = [&](std::span<const std::uint32_t> highlights) {
        return place_fillers(ldi, lens, fillers, blocked.samples, blocked.colours, highlights).hiding.count();
    };
    constexpr int rows = 10, board = 6;
    std::vector<std::uint32_t> wall;
    for (int y = 0; y < rows; ++y) {
        for (const std::size_t pixel :
             {ldi.windows.index(Imath::V2i(39, y)), ldi.windows.index(Imath::V2i(46, y))})
            wall.push_back(place_of(blocked.samples, ldi, pixel, ldi.pixel(pixel).front()));
    }
    std::ranges::sort(wall);
    EXPECT_EQ(hiding({}) - hiding(wall), rows * board);
}

} // namespace
} // namespace sparselens
