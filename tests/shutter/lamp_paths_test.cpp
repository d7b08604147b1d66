#include "shutter/lamp_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sparselens {
namespace {

using Parts = std::vector<LampPart>;

constexpr float depth = 20;

// A lamp of four pixels whose middle is at (x, y).
void add_lamp(Parts &parts, double x, double y, std::array<float, 3> light = {9, 8, 7}) {
    for (const float dx : {-0.5f, 0.5f})
        for (const float dy : {-0.5f, 0.5f}) parts.push_back({{float(x) + dx, float(y) + dy}, depth, light});
}

// Lamps in each of the moments, at these places.
std::vector<Parts> moving(int moments, int lamps, const auto &place) {
    std::vector<Parts> all;
    all.resize(std::size_t(moments));
    for (int m = 0; m < moments; ++m)
        for (int n = 0; n < lamps; ++n) {
            const Imath::V2d at = place(n, m);
            add_lamp(all[std::size_t(m)], at.x, at.y);
        }
    return all;
}

// The motion of the lamp whose middle is there; null: it does not move.
const LampMotion *motion_at(const LampPaths &paths, const Imath::V2d &at) {
    const LampMotion *motion = paths.of(Imath::V2f(float(at.x) - 0.5f, float(at.y) - 0.5f), depth);
    for (const float dx : {-0.5f, 0.5f})
        for (const float dy : {-0.5f, 0.5f}) {
            const LampMotion *part = paths.of({float(at.x) + dx, float(at.y) + dy}, depth);
            EXPECT_EQ(part != nullptr, motion != nullptr);
            if (part && motion) {
                EXPECT_EQ(part->velocity, motion->velocity);
            }
        }
    return motion;
}

void expect_still(const std::vector<Parts> &parts) {
    for (const LampPaths &paths : find_lamp_paths(parts)) EXPECT_TRUE(paths.empty());
}

TEST(LampPaths, ALampThatMovesEvenlyHasItsVelocity) {
    const auto place = [](int, int m) { return Imath::V2d(10 + 6 * m, 30 - 2 * m); };
    for (const int moments : {2, 3, 8}) {
        const std::vector<LampPaths> paths = find_lamp_paths(moving(moments, 1, place));
        for (int m = 0; m < moments; ++m) {
            const LampMotion *motion = motion_at(paths[std::size_t(m)], place(0, m));
            ASSERT_TRUE(motion) << m;
            EXPECT_NEAR(motion->velocity.x, 6, 1e-4);
            EXPECT_NEAR(motion->velocity.y, -2, 1e-4);
            EXPECT_NEAR(motion->bend.length(), 0, 1e-4);
            EXPECT_NEAR(paths[std::size_t(m)].farthest(), std::sqrt(40.0) / 2, 1e-4);
        }
    }
}

// A wheel that turns by 20 degrees each moment. A parabola through three places, at the times 0, 1 and 2, is off by at most
// |t (t - 1) (t - 2)| / 6 times the third derivative of the circle.
TEST(LampPaths, OfAWheelIsRound) {
    constexpr double radius = 40, turn = std::numbers::pi / 9, third = radius * turn * turn * turn;
    const auto place = [](int n, double m) {
        const double angle = n * std::numbers::pi / 3 + m * turn;
        return Imath::V2d(100, 100) + radius * Imath::V2d(std::cos(angle), std::sin(angle));
    };
    const std::vector<LampPaths> paths = find_lamp_paths(moving(5, 6, place));
    for (int m = 0; m < 5; ++m)
        for (int n = 0; n < 6; ++n) {
            const LampMotion *motion = motion_at(paths[std::size_t(m)], place(n, m));
            ASSERT_TRUE(motion) << n << ' ' << m;
            for (const float t : {-0.5f, -0.25f, 0.25f, 0.5f}) {
                const Imath::V2d at = place(n, m) + Imath::V2d(motion->at(t));
                const double time = double(t) + (m == 0 ? 0 : m == 4 ? 2 : 1);
                EXPECT_NEAR((at - place(n, m + double(t))).length(), 0,
                            std::abs(time * (time - 1) * (time - 2)) / 6 * third + 1e-3)
                    << n << ' ' << m << ' ' << t;
            }
        }
}

// If a row of lamps moves by more than half of its spacing, it seems to go back, as spokes of a wheel in a film. Its
// streaks are then the same but at its ends.
TEST(LampPaths, ARowOfLampsIsFollowedByTheShorterWay) {
    for (const double step : {9, 11}) {
        const auto place = [=](int n, int m) { return Imath::V2d(20 * n + step * m, 50); };
        const std::vector<LampPaths> paths = find_lamp_paths(moving(4, 8, place));
        for (int m = 0; m < 4; ++m)
            for (int n = 3; n < 5; ++n) {
                const LampMotion *motion = motion_at(paths[std::size_t(m)], place(n, m));
                ASSERT_TRUE(motion) << step << ' ' << n << ' ' << m;
                EXPECT_NEAR(motion->velocity.x, step < 10 ? step : step - 20, 1e-4);
            }
    }
}

// A lamp that is hidden in one moment is not taken for another one far away that is like it.
TEST(LampPaths, ALampDoesNotJumpOverOthers) {
    std::vector<Parts> parts(2);
    for (Parts &of : parts) add_lamp(of, 40, 20, {90, 80, 70});
    add_lamp(parts[0], 20, 20);
    add_lamp(parts[1], 150, 20);
    expect_still(parts);
}

TEST(LampPaths, WhatRestsOrChangesIsNotFollowed) {
    expect_still(moving(4, 3, [](int n, int) { return Imath::V2d(20 * n, 20); }));
    expect_still(moving(4, 1, [](int, int m) { return Imath::V2d(20 + 0.2 * m, 20); })); // hardly moves
    std::vector<Parts> blinking(2), coloured(2), deeper(2);
    add_lamp(blinking[0], 10, 10, {9, 9, 9});
    add_lamp(blinking[1], 16, 10, {4, 4, 4});
    expect_still(blinking);
    add_lamp(coloured[0], 10, 10, {9, 1, 1});
    add_lamp(coloured[1], 16, 10, {1, 9, 1});
    expect_still(coloured);
    add_lamp(deeper[0], 10, 10);
    add_lamp(deeper[1], 16, 10);
    for (LampPart &part : deeper[1]) part.depth *= 2;
    expect_still(deeper);
    std::vector<Parts> merging(2); // two lamps become one that is twice as bright
    add_lamp(merging[0], 10, 10);
    add_lamp(merging[0], 20, 10);
    add_lamp(merging[1], 15, 10, {18, 16, 14});
    expect_still(merging);
    expect_still(
        moving(4, 1, [](int, int m) { return Imath::V2d(20 + (m % 2) * 8, 20); })); // turns back each time
    expect_still({});
    expect_still({Parts()});
}

TEST(LampPaths, DoNotDependOnTheOrderOfPartsOrHowOftenTheyAreListed) {
    const auto place = [](int n, int m) { return Imath::V2d(30 * n + 7 * m, 20 + 30 * n); };
    std::vector<Parts> parts = moving(3, 4, place);
    const std::vector<LampPaths> paths = find_lamp_paths(parts);
    for (Parts &of : parts) {
        std::ranges::reverse(of);
        of.insert(of.end(), of.begin(), of.begin() + 5);
    }
    const std::vector<LampPaths> others = find_lamp_paths(parts);
    for (int m = 0; m < 3; ++m)
        for (int n = 0; n < 4; ++n) {
            const LampMotion *one = motion_at(paths[std::size_t(m)], place(n, m)),
                             *other = motion_at(others[std::size_t(m)], place(n, m));
            ASSERT_TRUE(one && other);
            EXPECT_EQ(one->velocity, other->velocity);
            EXPECT_EQ(one->bend, other->bend);
        }
}

// Noise in the dark stands out as well: the brightest lamps are followed.
TEST(LampPaths, ABrightLampIsFollowedAmongManyDimOnes) {
    constexpr int columns = 80;
    std::vector<Parts> parts(2);
    for (int m = 0; m < 2; ++m)
        for (int n = 0; n < int(LampPathTuning::most_lamps) + columns; ++n)
            add_lamp(parts[std::size_t(m)], 10 * (n % columns) + 3 * m, 10 * (n / columns), {1, 1, 1});
    const Imath::V2d bright(2000.5, 20.5);
    add_lamp(parts[0], bright.x, bright.y);
    add_lamp(parts[1], bright.x + 40, bright.y);
    const std::vector<LampPaths> paths = find_lamp_paths(parts);
    const LampMotion *motion = motion_at(paths[0], bright);
    ASSERT_TRUE(motion);
    EXPECT_NEAR(motion->velocity.x, 40, 1e-4);
}

} // namespace
} // namespace sparselens
