// The pixels of one lamp share shadows, which equal the shadows for each pixel to within a hundredth of the disc.
#include "base/numbers.h"
#include "dof/lens/block_footprints.h"
#include "dof/lens/blocked_fixture.h"
#include "dof/lens/fillers.h"
#include "dof/lens/highlight_shadows.h"
#include "dof/lens/highlights.h"
#include "dof/lens/sample_blocks.h"
#include "dof/lens/shadow_search.h"
#include "dof/tuning.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

namespace sparselens {
namespace {

constexpr int size = 64;
constexpr double lamp_coc = 280; // eight pixels in a group
const ThinLens lens{.radius = 2.4, .focal_px = 640, .focus = 5};
const Imath::Box2i box({0, 0}, {size - 1, size - 1});

// A lamp of eight by eight pixels before a wall, and boards of sixteen pixels before it with CoCs around a given one.
struct LampBehindBoards : BlockedLdi {
    BlockedSamples solids;
    BlockFootprints footprints, solid_footprints;
    std::vector<std::uint32_t> lamp;
    Highlights highlights;

    // Boards at one depth, and solids or samples `behind` pixels of CoC behind them.
    static Ldi solid_boards(double boards, double behind, bool are_solid) {
        return make_ldi(windows_of_size(size, size), rgba_channels(), [&](int x, int y) {
            std::vector<Sample> samples;
            if (random_unit(x / 16, y / 16, 1) < 0.4) {
                samples.push_back({depth_of(lens, boards), {0, 0, 0, 1}});
                if (are_solid)
                    samples.back().solid = behind / (lens.radius * lens.focal_px);
                else
                    samples.push_back({depth_of(lens, boards + behind), {0, 0, 0, 1}});
            }
            if (is_lamp(x, y)) samples.push_back({depth_of(lens, lamp_coc), {900, 900, 900, 1}});
            samples.push_back({depth_of(lens, lamp_coc + 9), {1, 1, 1, 1}});
            return samples;
        });
    }
    static Ldi scene(double boards, double coc = lamp_coc) {
        return make_ldi(windows_of_size(size, size), rgba_channels(), [&](int x, int y) {
            std::vector<Sample> samples;
            if (random_unit(x / 16, y / 16, 1) < 0.4)
                samples.push_back({depth_of(lens, boards - random_unit(x / 16, y / 16, 2)), {0, 0, 0, 1}});
            if (is_lamp(x, y)) samples.push_back({depth_of(lens, coc), {900, 900, 900, 1}});
            samples.push_back({depth_of(lens, coc + 9), {1, 1, 1, 1}});
            return samples;
        });
    }
    static bool is_lamp(int x, int y) { return x >= 24 && x < 32 && y >= 32 && y < 40; }

    explicit LampBehindBoards(const Ldi &from)
        : BlockedLdi(from, lens), solids(place_solids(ldi, lens, {}, samples)),
          footprints(ldi, samples, Links(ldi, lens)), solid_footprints(ldi, solids) {
        for (std::uint32_t i = 0; i < samples.count(); ++i)
            if (samples.source[i] != BlockedSamples::background && ldi.values[0][samples.source[i]] == 900)
                lamp.push_back(i);
        highlights.sample = lamp;
    }

    // The lit share at each pixel of the tile, for each sample of the lamp in turn.
    std::vector<float> lit(bool together, const CoarseCasters *coarse = nullptr) {
        HighlightShadows shadows(highlights, {{samples, footprints}, {solids, solid_footprints}});
        shadows.begin({0, 0}, 1, {1, 1}, coarse);
        std::vector<float> all;
        std::vector<std::uint32_t> group(lamp.size());
        std::iota(group.begin(), group.end(), 0u);
        if (together) shadows.share(group, box);
        for (const std::uint32_t h : group) {
            if (!together) shadows.share(std::span(&h, 1), box);
            const Lamp own = shadows.lamp(h);
            const bool any = shadows.cast(h, {own.centre, Imath::V2d(own.coc), box});
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) all.push_back(any ? shadows.lit(x, y) : 1);
        }
        return all;
    }
};

double mean(std::span<const float> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

// Shadows of boards in focus are at the boards, seen from any point of the lamp. Other shadows are off by |1 - m| times
// the distance to the middle of the group, four pixels on average. Boards of 16 pixels, two fifths of all, have edges
// every (16 m) pixels, across and down.
TEST(HighlightShadows, OfAGroupAreThoseOfEachSample) {
    for (const double boards : {0.5, -40.0, -280.0, 90.0, 130.0}) {
        const Ldi ldi = LampBehindBoards::scene(boards);
        LampBehindBoards scene(ldi);
        ASSERT_EQ(scene.lamp.size(), 64u);
        const std::vector<float> together = scene.lit(true), alone = scene.lit(false);
        const double m = lamp_coc / (lamp_coc - boards + 1);
        double off = 0;
        for (std::size_t i = 0; i < alone.size(); ++i) off += std::abs(double(together[i] - alone[i]));
        EXPECT_LE(off / double(alone.size()), 2 * 4 * std::abs(1 - m) / (16 * m) * 0.5 + 0.01) << boards;
        EXPECT_NEAR(mean(together), mean(alone), 0.02) << boards;
        EXPECT_LT(mean(alone), 0.95) << boards; // boards really hide the lamp
        EXPECT_GT(mean(alone), 0.1) << boards;
    }
}

// Relative to the discs, shadows on two members are at most 5.6 m pixels apart, which is less than a hundredth of this
// disc's radius; in the picture, they are farther apart than that. They lie in a square of 64 m pixels.
TEST(HighlightShadows, OfWhatIsFarInFrontMoveWithTheDiscs) {
    constexpr double coc = 80, boards = -8 * coc, m = coc / (coc - boards + 1), square = 64 * m * 64 * m;
    const Ldi ldi = LampBehindBoards::scene(boards, coc);
    LampBehindBoards scene(ldi);
    const std::vector<float> together = scene.lit(true), alone = scene.lit(false);
    double off = 0, in_place = 0, hidden = 0; // in_place: if the shadow of one sample were used for all
    for (std::size_t i = 0; i < alone.size(); ++i) {
        off += std::abs(double(together[i] - alone[i]));
        in_place += std::abs(double(alone[i % (size * size)] - alone[i]));
        hidden += 1 - double(alone[i]);
    }
    const double lamps = double(scene.lamp.size());
    EXPECT_LE(off / lamps, square * 2 * 4 * m / (16 * m) * 0.5);
    EXPECT_GT(in_place, 2 * off);
    EXPECT_GT(hidden / lamps, 0.1 * square);
    EXPECT_LT(hidden / lamps, 0.9 * square);
    EXPECT_GT(off, 0); // else they were not shared
}

TEST(HighlightShadows, OfWhatStandsRightBeforeALampAreCastForEachSample) {
    const Ldi ldi = LampBehindBoards::scene(0.9 * lamp_coc);
    LampBehindBoards scene(ldi);
    const std::vector<float> together = scene.lit(true), alone = scene.lit(false);
    EXPECT_EQ(together, alone);
    EXPECT_LT(mean(alone), 0.99);
}

// Three lamps around the point (11, 31), 0.12 pixels apart and behind things of given CoCs (NaN: nothing is there). The
// first is their middle. The last has the CoC 81, the others 80.
Ldi three_lamps(const std::function<double(int x, int y)> &coc_at) {
    return make_ldi(windows_of_size(size, size), rgba_channels(), [&](int x, int y) {
        std::vector<Sample> samples;
        if (!std::isnan(coc_at(x, y))) samples.push_back({depth_of(lens, coc_at(x, y)), {0, 0, 0, 1}});
        if ((x == 10 && (y == 30 || y == 31)) || (x == 11 && y == 30))
            samples.push_back({depth_of(lens, y == 31 ? 81 : 80),
                               {900, 900, 900, 0.5f},
                               x == 10 ? 0.44f : -0.44f,
                               y == 30 ? 0.44f : -0.44f});
        samples.push_back({depth_of(lens, 90), {1, 1, 1, 1}});
        return samples;
    });
}

// Whether each of the three lamps lights a pixel, all or none of it.
std::array<bool, 3> lights(const std::vector<float> &lit, int x, int y) {
    std::array<bool, 3> result{};
    for (std::size_t lamp = 0; lamp < 3; ++lamp) {
        const float share = lit[(lamp * size + std::size_t(y)) * size + std::size_t(x)];
        EXPECT_TRUE(share == 0 || share == 1);
        result[lamp] = share == 1;
    }
    return result;
}
constexpr std::array<bool, 3> all_light{true, true, true}, none_lights{}, last_does_not{true, true, false};

// A thing of CoC 71.3, whose left edge lies 6 pixels beside the lamps, casts a shadow from pixel 65 or 66 on for lamps of
// CoC 80, beyond the tile, and from pixel 61 on for the lamp of CoC 81. Something in focus hides the pixels that it
// covers from each.
TEST(HighlightShadows, OnALampFartherThanItsGroupAreCastWithThoseThatAllShare) {
    const Ldi ldi = three_lamps([](int x, int y) {
        const bool in_focus = x >= 40 && x < 44 && y >= 20 && y < 24;
        return x == 17 && y == 31 ? 71.3 : in_focus ? 0 : NAN;
    });
    LampBehindBoards scene(ldi);
    ASSERT_EQ(scene.lamp.size(), 3u);
    for (const bool together : {false, true}) {
        const std::vector<float> lit = scene.lit(together);
        EXPECT_EQ(lights(lit, 63, 35), last_does_not) << together;
        EXPECT_EQ(lights(lit, 60, 35), all_light) << together;
        EXPECT_EQ(lights(lit, 41, 21), none_lights) << together;
    }
}

// A board of the CoC -80, in cells of four pixels from pixel 24 to 40: its shadow is half as large, at half the
// distance from the lamps.
TEST(HighlightShadows, OfCoarseCastersFallOnGroupsToo) {
    const ThinLens in_cells{.radius = lens.radius, .focal_px = lens.focal_px / 4, .focus = lens.focus};
    const Ldi cells = make_ldi(windows_of_size(size / 4, size / 4), rgba_channels(), [&](int x, int y) {
        const bool board = x >= 6 && x < 10 && y >= 6 && y < 10;
        return std::vector<Sample>{{depth_of(in_cells, board ? -20 : 22.5), {0, 0, 0, 1}}};
    });
    const BlockedLdi blocked(cells, in_cells);
    const BlockFootprints footprints(blocked.ldi, blocked.samples);
    const CoarseCasters coarse{{{blocked.samples, footprints, 4}}, GatherTuning::shadow_far_cells};
    const Ldi ldi = three_lamps([](int, int) { return NAN; });
    LampBehindBoards scene(ldi);
    for (const bool together : {false, true}) {
        const std::vector<float> lit = scene.lit(together, &coarse);
        EXPECT_EQ(lights(lit, 20, 31), none_lights) << together;
        EXPECT_EQ(lights(lit, 15, 31), all_light) << together;
        EXPECT_EQ(lights(lit, 27, 31), all_light) << together;
    }
}

TEST(HighlightGroups, HoldEachSampleOnceAndAreSmall) {
    const Ldi ldi = make_ldi(windows_of_size(size, size), rgba_channels(), [&](int x, int y) {
        const double c = std::exp(8 * random_unit(x / 16, y / 16, 1) - 1) * (x < 32 ? 1 : -1);
        return std::vector<Sample>{{depth_of({.radius = 50, .focal_px = 640, .focus = 5}, c), {1, 1, 1, 1}}};
    });
    const BlockedLdi blocked(ldi, {.radius = 50, .focal_px = 640, .focus = 5});
    const BlockedSamples &samples = blocked.samples;
    std::vector<std::uint32_t> every(samples.count());
    std::iota(every.begin(), every.end(), 0u);
    const HighlightGroups groups({samples, every, {}});
    std::size_t several = 0;
    for (std::uint32_t b = 0; b < samples.blocks.size(); ++b) {
        const SampleBlock &block = samples.blocks[b];
        std::vector<std::uint32_t> all(block.end - block.begin), found;
        std::iota(all.begin(), all.end(), block.begin);
        groups.for_each(b, [&](std::span<const std::uint32_t> group) {
            found.insert(found.end(), group.begin(), group.end());
            several += group.size() > 1;
            for (const std::uint32_t i : group) {
                const float reach = GatherTuning::lamp_group_of_coc * std::abs(samples.coc[group[0]]);
                EXPECT_TRUE(i == group[0] || std::abs(samples.x[i] - samples.x[group[0]]) <= reach);
                EXPECT_TRUE(i == group[0] || std::abs(samples.y[i] - samples.y[group[0]]) <= reach);
                EXPECT_LE(std::abs(samples.depth(i) - samples.depth(group[0])), one_surface_px);
            }
        });
        std::ranges::sort(found);
        EXPECT_EQ(found, all);
    }
    EXPECT_GT(several, 10u);
}

// Boards before others, and a leaning surface whose samples part. Bounds of areas hold those of blocks.
TEST(BlockFootprints, LieWithinTheirBounds) {
    const Ldi ldi = make_ldi(windows_of_size(100, 70), rgba_channels(), [&](int x, int y) {
        const double z = x < 40 ? double(depth_of(lens, -60 + 3 * x)) : 2 + 20 * random_unit(x / 7, y / 5, 1);
        return std::vector<Sample>{{float(z), {1, 1, 1, 1}}, {float(z + 9), {1, 1, 1, 1}}};
    });
    const BlockedLdi blocked(ldi, lens);
    const BlockFootprints footprints(ldi, blocked.samples, Links(ldi, lens));
    for (const double z : {1.0, 2.5, 4.0, 11.0, 24.0, 45.0, 1e6}) {
        const auto depth = float(disparity(lens, z));
        const auto reaches = [&](const CasterBounds &bounds) { return bounds.depth_max > depth; };
        int blocks = 0;
        footprints.for_each(reaches, [&](std::uint32_t block, const CasterBounds &own) {
            const CasterBounds *near = footprints.of(block).nearer_than(depth);
            for (const auto &[footprint, farthest, nearest, sample] : footprints.of(block).joined)
                for (const CasterBounds &bounds : {own, near ? *near : own}) {
                    if (!(nearest > depth)) continue;
                    const auto &[p, coc] = footprint;
                    const auto [least, most] = std::ranges::minmax(coc);
                    const CocRange cocs = bounds.cocs_between(farthest, nearest);
                    EXPECT_TRUE(cocs.least <= least && most <= cocs.most);
                    EXPECT_TRUE(bounds.depth_min <= nearest && nearest <= bounds.depth_max);
                    EXPECT_TRUE(bounds.place.min.x - 1 <= p[0] && p[1] <= bounds.place.max.x + 1);
                    EXPECT_TRUE(bounds.place.min.y - 1 <= p[2] && p[3] <= bounds.place.max.y + 1);
                }
            return near && ++blocks > 0;
        });
        for (const SampleBlock &block : blocked.samples.blocks) blocks -= block.depth_max > depth;
        EXPECT_EQ(blocks, 0);
    }
}

// At that depth they are at the same position, and cast the same shadows as visible things.
TEST(HighlightShadows, WhatIsSolidCastsThem) {
    const auto lit = [](bool are_solid) {
        const Ldi ldi = LampBehindBoards::solid_boards(40, 30, are_solid);
        return LampBehindBoards(ldi).lit(true);
    };
    const std::vector<float> solid = lit(true), seen = lit(false);
    EXPECT_LT(mean(solid), 0.9);
    EXPECT_EQ(solid, seen);
    const Ldi bare = LampBehindBoards::solid_boards(40, 0, true);
    EXPECT_LT(mean(solid), mean(LampBehindBoards(bare).lit(true)) - 0.02);
}

} // namespace
} // namespace sparselens
