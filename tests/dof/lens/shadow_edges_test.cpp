// Shadows of a square pixel, by hand; and shadows of a group, computed for its middle lamp, compared with those of each
// lamp.
#include "dof/lens/shadow_search.h"
#include "support/ldi_samples.h"

#include <gtest/gtest.h>

#include <random>

namespace sparselens {
namespace {

ShadowedLamp lamp_at(const Imath::V2d &centre, double coc) {
    return {.sample = 0,
            .lamp = {centre, coc, 1},
            .origin = {0, 0},
            .screen = {centre, Imath::V2d(coc), {{0, 0}, {63, 63}}},
            .depth = 0,
            .hardly = 0,
            .far = 0,
            .place = {}};
}
Footprint square_at(float x, float y, float coc) {
    return {{x - 0.5f, x + 0.5f, y - 0.5f, y + 0.5f}, {coc, coc, coc, coc}};
}
ShadowEdges edges_of(const ShadowedLamp &lamp, const Footprint &thing) { return {lamp, 1, {0, 0}, thing}; }

// A lamp with a CoC of 100 pixels at (10, 20); an object with half that CoC casts a shadow twice as large about the
// lamp.
TEST(ShadowEdges, AreThoseOfTheThingMagnifiedAboutTheLamp) {
    const ShadowedLamp lamp = lamp_at({10, 20}, 100);
    const Imath::Box2f shadow = edges_of(lamp, square_at(15, 22, 50)).shadow();
    EXPECT_EQ(shadow.min, Imath::V2f(19, 23));
    EXPECT_EQ(shadow.max, Imath::V2f(21, 25));
    EXPECT_TRUE(reaches(shadow, lamp.screen.box));
    EXPECT_FALSE(reaches(shadow, {{22, 0}, {63, 63}}));
    EXPECT_FALSE(reaches(shadow, {{0, 0}, {63, 21}}));
}

TEST(ShadowEdges, OfWhatIsMoreBlurredAreTheOtherWayRound) {
    const ShadowedLamp lamp = lamp_at({10, 20}, 100);
    const Imath::Box2f shadow = edges_of(lamp, square_at(11, 19, 200)).shadow();
    EXPECT_EQ(shadow.min, Imath::V2f(8.5f, 20.5f));
    EXPECT_EQ(shadow.max, Imath::V2f(9.5f, 21.5f));
    EXPECT_FALSE(edges_of(lamp, square_at(11, 19, 200)).as_blurred());
    EXPECT_TRUE(edges_of(lamp, square_at(10.5f, 20.5f, 100)).as_blurred());
}

TEST(ShadowEdges, WhatReachesAMemberMayReachItsGroup) {
    std::mt19937 random(3);
    const auto between = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(random);
    };
    int reached = 0, left_out = 0;
    for (int i = 0; i < 4000; ++i) {
        ShadowedLamp group = lamp_at({between(-100, 160), between(-100, 160)}, between(64, 800));
        const ShadowedLamp member = lamp_at(group.lamp.centre + Imath::V2d(between(-5, 5), between(-5, 5)),
                                            group.lamp.coc + between(-0.5, 0.5));
        group.spread = 5 * std::sqrt(2.0), group.cocs = 0.5;
        const Footprint thing = square_at(float(between(-100, 160)), float(between(-100, 160)),
                                          float(between(-100, 1.2 * group.lamp.coc)));
        const ShadowEdges of_member = edges_of(member, thing);
        const bool reaches_member = !of_member.as_blurred() && reaches(of_member.shadow(), member.screen.box);
        const bool may = edges_of(group, thing).may_reach(group);
        EXPECT_TRUE(may || !reaches_member);
        reached += reaches_member, left_out += !may;
    }
    EXPECT_GT(reached, 100);
    EXPECT_GT(left_out, 1000);
}

// Two things at x = 78.5, in one block. A lamp of CoC 9 at 0 lights pixel 7 through lens points up to 8 / 9; through
// these it is seen behind things of CoC -80 up to x = (9 + 80) * 8 / 9 = 79. For a lamp of CoC 10 these are x = 72. The
// field is bent: the second thing, too, is nearer than the lamps, but has a larger CoC.
TEST(ShadowSearch, FindsForAGroupWhatMayShadowAMember) {
    const Windows windows = windows_of_size(80, 8);
    const Ldi ldi = make_ldi(windows, rgba_channels(), [](int x, int y) {
        return x == 78 && y == 3 ? std::vector<Sample>{{1, {0, 0, 0, 1}}, {2, {0, 0, 0, 1}}}
                                 : std::vector<Sample>{};
    });
    const BlockedSamples samples =
        make_blocks(windows, [](const Position &at, std::vector<PlacedSample> &placed) {
            if (at != Position(78, 3)) return;
            placed.push_back({78.5f, 3.5f, -80, 100, 1, 0});
            placed.push_back({78.5f, 3.5f, 12, 50, 1, 1});
        });
    const BlockFootprints footprints(ldi, samples);
    ShadowSearch search({{samples, footprints}});
    search.begin({1, 1}, nullptr);
    const auto found = [&](double coc, double cocs) {
        ShadowedLamp lamp = lamp_at({0, 3.5}, coc);
        lamp.screen.box = {{7, 3}, {7, 3}};
        lamp.far = INFINITY;
        lamp.cocs = cocs;
        int blocks = 0;
        search.for_each(lamp, [&](const CastingBlock &) { return ++blocks > 0; });
        return blocks;
    };
    EXPECT_EQ(found(9, 0), 1);
    EXPECT_EQ(found(10, 0), 0);
    EXPECT_EQ(found(10, 1), 1);
}

} // namespace
} // namespace sparselens
