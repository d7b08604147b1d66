#include "base/numbers.h"
#include "deep/checks/pose_check.h"
#include "support/views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace sparselens {
namespace {

constexpr double focal_px = 100;

// Colours that identify a position on a surface, a few pixels large.
float pattern(double x, double y, double z) {
    const auto cell = [z](double v) { return std::uint32_t(std::floor(v / z * 25) + 1000); };
    return float(unit_interval(mix_bits(cell(x), mix_bits(cell(y), std::uint32_t(z)))));
}

// A card before a wall, seen from `position`: 0.1 to the side moves them by 5 and 1 px.
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

// The same card as a mirror before a white wall: it shows a pattern three times as far away as the card.
View mirror_before_wall(const Imath::V2d &position) {
    View view = card_before_wall(position);
    const Windows &w = view.image.windows;
    const std::size_t red = find_channel(view.image.channels, "R");
    for (int y = w.data.min.y; y <= w.data.max.y; ++y)
        for (int x = w.data.min.x; x <= w.data.max.x; ++x) {
            const double z = 6;
            const Imath::V2d seen((x + 0.5 - 80) / focal_px * z + position.x,
                                  -(y + 0.5 - 60) / focal_px * z + position.y);
            view.image.at(red, x, y) = view.z[w.index(Imath::V2i(x, y))] < 5 ? pattern(seen.x, seen.y, z) : 1;
        }
    return view;
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

TEST(PoseCheck, AWrongDistanceFromTheCentreIsFound) {
    const View centre = card_before_wall({0, 0}), view = card_before_wall({0.15, 0.05});
    for (const double factor : {0.25, 0.4, 0.5, 2.0, 2.5, 4.0}) {
        const auto better =
            better_position(centre, said_to_stand_at(view, Imath::V2d(0.15, 0.05) * factor), focal_px);
        ASSERT_TRUE(better) << factor;
        EXPECT_LT((*better - Imath::V2d(0.15, 0.05)).length(), 0.02) << factor; // one pixel at the card
    }
}

TEST(PoseCheck, ARimViewAtTheCentreIsFoundAndTheReverse) {
    const View centre = card_before_wall({0, 0});
    for (const Imath::V2d &at : {Imath::V2d(0.15, 0.05), Imath::V2d(-0.02, 0.15), Imath::V2d(0, -0.1)})
        for (const double reach : {0.0, 0.15, 0.3}) {
            const View view = said_to_stand_at(card_before_wall(at), {0, 0});
            const auto better = better_position(centre, view, focal_px, reach);
            ASSERT_TRUE(better) << at << reach;
            EXPECT_LT((*better - at).length(), 0.04) << at << reach; // two pixels
        }
    const auto better = better_position(centre, said_to_stand_at(centre, {0.1, 0}), focal_px);
    ASSERT_TRUE(better);
    EXPECT_EQ(*better, Imath::V2d(0, 0));
    EXPECT_FALSE(better_position(centre, centre, focal_px, 0.1));
}

TEST(PoseCheck, MirrorsDoNotMislead) {
    const View centre = mirror_before_wall({0, 0}), view = mirror_before_wall({0.15, 0.05});
    EXPECT_FALSE(better_position(centre, view, focal_px));
    EXPECT_FALSE(turned_by(centre, view, focal_px));
    for (const double factor : {0.4, 2.5}) { // colours would give a third of it
        const auto better =
            better_position(centre, said_to_stand_at(view, Imath::V2d(0.15, 0.05) * factor), focal_px);
        ASSERT_TRUE(better) << factor;
        EXPECT_LT((*better - Imath::V2d(0.15, 0.05)).length(), 0.04) << factor; // two pixels
    }
}

// A floor up to the horizon, whose depth changes by more than a pose may err from one row to the next.
View floor_seen_from(const Imath::V2d &position) {
    return make_view(windows_of_size(160, 120), position, [&](int px, int py) {
        const double down = (py + 0.5 - 60) / focal_px,
                     z = down > 0 ? std::min(10.0, (1 + position.y) / down) : 10;
        const Imath::V2d p((px + 0.5 - 80) / focal_px * z + position.x, z < 10 ? z : -down * z + position.y);
        return ViewPixel{.z = float(z), .r = pattern(p.x, p.y, z < 10 ? 2 : 10)};
    });
}

TEST(PoseCheck, AFloorDoesNotMislead) {
    const View centre = floor_seen_from({0, 0});
    for (const double height : {0.02, 0.04, 0.06, -0.04}) {
        const View view = floor_seen_from({0, height});
        EXPECT_FALSE(better_position(centre, view, focal_px)) << height;
        EXPECT_FALSE(turned_by(centre, view, focal_px)) << height;
        EXPECT_TRUE(better_position(centre, said_to_stand_at(view, {0, -height}), focal_px)) << height;
    }
}

// A window fills the picture: everything is farther than its panes, and moves less.
TEST(PoseCheck, WithoutEdgesOfDepthNeitherDistancesNorTurnsAreTold) {
    const auto window = [](const Imath::V2d &position) {
        View view = card_before_wall(position * 0.5);
        std::ranges::fill(view.z, 2.0f);
        return said_to_stand_at(view, position);
    };
    const View centre = window({0, 0}), view = window({0.2, 0});
    EXPECT_FALSE(better_position(centre, view, focal_px));
    EXPECT_FALSE(turned_by(centre, view, focal_px));
}

View grey() {
    return make_view(windows_of_size(160, 120), {0, 0},
                     [](int, int) { return ViewPixel{.z = 3, .r = 0.5f}; });
}

TEST(PoseCheck, WithoutTextureNothingIsSaid) {
    EXPECT_FALSE(better_position(grey(), said_to_stand_at(grey(), {0.1, 0}), focal_px));
    EXPECT_FALSE(better_position(grey(), grey(), focal_px, 0.1));
    const std::vector<View> views{grey(), said_to_stand_at(grey(), {0.1, 0})};
    EXPECT_FALSE(same_picture(referring_to(views), 1, focal_px));
}

TEST(PoseCheck, TheSamePictureFromTwoPlacesIsFound) {
    const View view = card_before_wall({0.1, 0});
    std::vector<View> views{card_before_wall({0, 0}), view, card_before_wall({-0.1, 0}),
                            said_to_stand_at(view, {0, 0.1})};
    EXPECT_EQ(same_picture(referring_to(views), 3, focal_px), std::optional<std::size_t>(1));
    EXPECT_FALSE(same_picture(referring_to(views), 1, focal_px));
    EXPECT_FALSE(same_picture(referring_to(views), 2, focal_px));
    views[3].position = {0.1, 0.005}; // a twentieth of a pixel away at the wall, a quarter at the card
    EXPECT_FALSE(same_picture(referring_to(views), 3, focal_px));
}

// The picture moved by `by` pixels, right and down, approximately as by turning the camera.
View shifted(const View &view, const Imath::V2i &by) {
    View moved = view;
    const Windows &w = view.image.windows;
    for (int y = w.data.min.y; y <= w.data.max.y; ++y)
        for (int x = w.data.min.x; x <= w.data.max.x; ++x) {
            const Imath::V2i from(std::clamp(x - by.x, w.data.min.x, w.data.max.x),
                                  std::clamp(y - by.y, w.data.min.y, w.data.max.y));
            moved.z[w.index(Imath::V2i(x, y))] = view.z[w.index(from)];
            for (std::size_t k = 0; k < view.image.channels.size(); ++k)
                moved.image.at(k, x, y) = view.image.at(k, from.x, from.y);
        }
    return moved;
}

TEST(PoseCheck, ATurnedViewIsNamedAsTurned) {
    const View centre = card_before_wall({0, 0}), view = card_before_wall({0.15, 0.05});
    EXPECT_FALSE(turned_by(centre, view, focal_px));
    for (const Imath::V2i &by : {Imath::V2i(7, 0), Imath::V2i(-9, 3), Imath::V2i(0, -12)}) {
        const auto turned = turned_by(centre, shifted(view, by), focal_px);
        ASSERT_TRUE(turned) << by;
        const auto degrees = [](int pixels) { return std::atan2(pixels, focal_px) * 180 / std::numbers::pi; };
        EXPECT_NEAR(turned->x, degrees(-by.x), degrees(1)) << by;
        EXPECT_NEAR(turned->y, degrees(by.y), degrees(1)) << by;
    }
    for (const Imath::V2d &wrong : {Imath::V2d(-0.15, -0.05), Imath::V2d(0, 0), Imath::V2d(0.3, 0.1)})
        EXPECT_FALSE(turned_by(centre, said_to_stand_at(view, wrong), focal_px)) << wrong;
}

TEST(PoseCheck, TheSamePictureFromTheSamePlaceIsFound) {
    const View view = card_before_wall({0.1, 0});
    const std::vector<View> views{card_before_wall({0, 0}), view, card_before_wall({-0.1, 0}), view,
                                  said_to_stand_at(view, {0, 0.1})};
    EXPECT_EQ(same_picture_and_place(referring_to(views), 3), std::optional<std::size_t>(1));
    for (const std::size_t i : {1u, 2u, 4u})
        EXPECT_FALSE(same_picture_and_place(referring_to(views), i)) << i;
    View empty = view;
    std::ranges::fill(empty.z, 0.0f);
    EXPECT_FALSE(same_picture_and_place(referring_to(std::vector<View>{empty, empty}), 1))
        << "nothing of them was worth rendering";
}

// Views of which only the positions count; the first has the position of the first view.
std::vector<PackedView> standing_at(const std::vector<Imath::V2d> &places) {
    std::vector<PackedView> views;
    for (const Imath::V2d &place : places)
        views.emplace_back(
            make_view(windows_of_size(1, 1), place - places[0], [](int, int) { return ViewPixel{}; }));
    return views;
}

TEST(PoseCheck, TheFirstHasToBeInTheMiddle) {
    const double r = 0.06, d = r * std::sqrt(0.5), h = r * std::sqrt(0.75);
    const std::vector<Imath::V2d> four{{r, 0}, {0, r}, {-r, 0}, {0, -r}},
        three{{r, 0}, {-r / 2, h}, {-r / 2, -h}};
    EXPECT_TRUE(first_is_at_the_edge(standing_at(four), 0));
    EXPECT_TRUE(first_is_at_the_edge(standing_at(three), r));
    EXPECT_TRUE(first_is_at_the_edge(standing_at({{r, 0}, {0, r}, {-r, 0}, {0, -r}, {0, 0}}), 0));
    EXPECT_EQ(view_in_the_middle(standing_at({{r, 0}, {0, r}, {-r, 0}, {0, -r}, {0, 0}})),
              std::optional<std::size_t>(4));
    EXPECT_FALSE(view_in_the_middle(standing_at(four)));
    for (const auto &places :
         std::vector<std::vector<Imath::V2d>>{{{0, 0}},
                                              {{0, 0}, {r, 0}},
                                              {{0, 0}, {r, 0}, {0, r}, {-r, 0}, {0, -r}},
                                              {{0, 0}, {r, 0}, {d, d}, {0, r}},  // one quarter of the rim
                                              {{0, 0}, {r, 0}, {0, r}, {-r, 0}}, // one view is missing
                                              {{0, 0}, {r, 0}, {r / 2, 0}, {-r, 0}}}) // along a line
        EXPECT_FALSE(first_is_at_the_edge(standing_at(places), r));
}

// A planned view without margin: the few pixels that land on surfaces visible to the centre are mixed edge pixels,
// which contradict it.
TEST(PoseCheck, WhatTheCentreCannotSeeSaysNothing) {
    const View centre = card_before_wall({0, 0});
    View view = card_before_wall({0.1, 0});
    const Windows &w = view.image.windows;
    const std::size_t red = find_channel(view.image.channels, "R"),
                      alpha = find_channel(view.image.channels, "A");
    for (int y = w.data.min.y; y <= w.data.max.y; ++y)
        for (int x = w.data.min.x; x <= w.data.max.x; ++x) {
            // Behind the card's right edge, which is at 105 in the centre view and at 100 here.
            const bool hidden = x >= 100 && x < 104 && y >= 40 && y < 80, edge = x == 104 && y == 60;
            if (!hidden && !edge) view.image.at(alpha, x, y) = 0;
            if (edge) view.image.at(red, x, y) = 50;
        }
    EXPECT_FALSE(better_position(centre, view, focal_px));
}

} // namespace
} // namespace sparselens
