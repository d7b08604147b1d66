#include "base/random.h"
#include "support/views.h"
#include "warp/pose_check.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sparselens {
namespace {

constexpr double focal_px = 100;

// Colours that say where on which surface a place is, a few pixels large.
float pattern(double x, double y, double z) {
    const auto cell = [z](double v) { return std::uint32_t(std::floor(v / z * 25) + 1000); };
    return float(unit_interval(mix_bits(cell(x), mix_bits(cell(y), std::uint32_t(z)))));
}

// A card before a wall, seen from `position`: 0.1 to the side they move by 5 and 1 px.
View card_before_wall(const Imath::V2d &position) {
    return make_view(windows_of_size(160, 120), position, [&](int px, int py) {
        const auto place = [&](double z) {
            return Imath::V2d((px + 0.5 - 80) / focal_px * z + position.x,
                              -(py + 0.5 - 60) / focal_px * z + position.y);
        };
        const Imath::V2d near = place(2), far = place(10);
        const bool card = std::abs(near.x) < 0.5 && std::abs(near.y) < 0.4;
        const Imath::V2d &p = card ? near : far;
        const double z = card ? 2 : 10;
        return ViewPixel{.z = float(z), .r = pattern(p.x, p.y, z)};
    });
}

View said_to_stand_at(View view, const Imath::V2d &position) {
    view.position = position;
    return view;
}

TEST(PoseCheck, OneInItsPlaceAgrees) {
    const View centre = card_before_wall({0, 0});
    for (const Imath::V2d &at : {Imath::V2d(0.1, 0), Imath::V2d(0, -0.1), Imath::V2d(0.06, 0.08)})
        EXPECT_FALSE(better_position(centre, card_before_wall(at), focal_px)) << at;
}

TEST(PoseCheck, AWrongSignOrAxisIsFound) {
    const View centre = card_before_wall({0, 0}), view = card_before_wall({0.15, 0.05});
    for (const Imath::V2d &wrong :
         {Imath::V2d(-0.15, -0.05), Imath::V2d(0.15, -0.05), Imath::V2d(0.05, 0.15)}) {
        const auto better = better_position(centre, said_to_stand_at(view, wrong), focal_px);
        ASSERT_TRUE(better) << wrong;
        EXPECT_EQ(*better, Imath::V2d(0.15, 0.05)) << wrong;
    }
}

// A planned view without margin: the little that lands on what the centre shows are mixed pixels of an edge, and
// contradicts it.
TEST(PoseCheck, WhatTheCentreCannotSeeSaysNothing) {
    const View centre = card_before_wall({0, 0});
    View view = card_before_wall({0.1, 0});
    const Windows &w = view.image.windows;
    const std::size_t red = find_channel(view.image.channels, "R"),
                      alpha = find_channel(view.image.channels, "A");
    for (int y = w.data.min.y; y <= w.data.max.y; ++y)
        for (int x = w.data.min.x; x <= w.data.max.x; ++x) {
            // Behind the card's right edge, which stands at 105 in the centre view and at 100 here.
            const bool hidden = x >= 100 && x < 104 && y >= 40 && y < 80, edge = x == 104 && y == 60;
            if (!hidden && !edge) view.image.at(alpha, x, y) = 0;
            if (edge) view.image.at(red, x, y) = 50;
        }
    EXPECT_FALSE(better_position(centre, view, focal_px));
}

} // namespace
} // namespace sparselens
