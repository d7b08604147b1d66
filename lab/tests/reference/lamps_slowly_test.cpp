// The light of highlights, tile by tile, equals the light that each point in each pixel sees through the lens.
#include "dof/lens/highlight_tile.h"
#include "dof/lens/highlights.h"
#include "lab/reference/lamps_slowly.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

namespace sparselens {
namespace {

constexpr int size = 36, places = 16;
constexpr std::size_t red_channel = 0;

struct Case {
    const char *name;
    double lamp_coc, before_coc; // CoC of the lamps, and mean CoC of the things before them
    double partial = 0;          // share of those things with partial coverage
    double steep = 0;            // change of CoC per pixel of a leaning surface before them
    double aspect = 1;
    bool lamps_partial = false;
    bool hidden = true; // whether anything hides part of them
    double wall = 1.5;  // how much more blurred the wall is than the lamps
};

void PrintTo(const Case &c, std::ostream *out) { *out << c.name; }

ThinLens lens_of(const Case &c) {
    return {.radius = 0.12, .focal_px = 640, .focus = 5, .pixel_aspect = c.aspect};
}

// Three lamps before a dim wall. Before them are boards of four by five pixels at random depths, or one leaning surface
// with a slit.
Ldi scene(const Case &c, const ThinLens &lens) {
    Windows windows = windows_of_size(size, size);
    windows.pixel_aspect = float(c.aspect);
    return make_ldi(windows, rgba_channels(), [&](int x, int y) {
        std::vector<Sample> samples;
        const bool board = random_unit(x / 4, y / 5, 1) < 0.4, slit = x / 2 % 5 == 0;
        const float alpha =
            random_unit(x / 4, y / 5, 2) < c.partial ? 0.2f + 0.6f * float(random_unit(x / 4, y / 5, 3)) : 1;
        const double coc = c.steep > 0 ? c.before_coc + c.steep * (x - size / 2) + 0.01 * random_unit(x, y, 4)
                                       : c.before_coc - 2 * random_unit(x / 4, y / 5, 5);
        if (c.steep > 0 ? !slit : board)
            samples.push_back({depth_of(lens, coc), {0, 0, 0, alpha}, float(random_unit(x, y, 6) - 0.5) / 4});
        const bool lamp = (x == 11 && y == 14) || (x == 24 && y == 20) || (x == 25 && y == 20);
        const float share = c.lamps_partial ? 0.5f : 1;
        if (lamp)
            samples.push_back(
                {depth_of(lens, c.lamp_coc), {900 * share, 600 * share, 300 * share, share}, 0.2f, -0.3f});
        samples.push_back({depth_of(lens, c.lamp_coc + c.wall), {0.1f, 0.1f, 0.1f, 1}});
        return samples;
    });
}

// The number of lamp discs that contain the pixel partly (on their rim) or fully.
struct Discs {
    int rims = 0, whole = 0;
};

Discs discs_at(const Case &c, const Imath::V2i &pixel) {
    Discs discs;
    for (const Imath::V2i &lamp : {Imath::V2i(11, 14), {24, 20}, {25, 20}}) {
        double nearest = INFINITY, farthest = 0;
        for (int k = 0; k < 9; ++k) { // corners, and the middles between them
            const double x = pixel.x + k % 3 / 2.0 - (lamp.x + 0.5 + double(0.2f)),
                         y = pixel.y + k / 3 / 2.0 - (lamp.y + 0.5 - double(0.3f));
            nearest = std::min(nearest, std::hypot(x, y / c.aspect));
            farthest = std::max(farthest, std::hypot(x, y / c.aspect));
        }
        const double radius = std::abs(c.lamp_coc);
        if (farthest < radius)
            ++discs.whole;
        else if (nearest < radius + 0.1) // a rim may pass between the nine points
            ++discs.rims;
    }
    return discs;
}

class LampsSlowly : public testing::TestWithParam<Case> {};

TEST_P(LampsSlowly, AreTheLightOfATile) {
    const Case &c = GetParam();
    const ThinLens lens = lens_of(c);
    const Ldi ldi = scene(c, lens);
    GatherScene lit{&ldi, ldi.windows.data,
                    lens, std::make_unique<Optics>(ldi, lens, LensLooks{}, 0),
                    {},   make_blocks(ldi, lens, ldi.windows.data),
                    {},   {},
                    {},   {}};
    const BlockedSamples &samples = lit.samples;
    lit.colours = make_colours(ldi, samples);
    const Highlights &highlights = lit.highlights = take_highlights(ldi, samples, lit.colours);
    ASSERT_EQ(highlights.sample.size(), 3u);
    std::vector<SlowLamp> lamps;
    for (std::size_t h = 0; h < 3; ++h)
        lamps.push_back({samples.source[highlights.sample[h]],
                         {double(highlights.light.at(0, h)), double(highlights.light.at(1, h)),
                          double(highlights.light.at(2, h))}});
    const std::vector<SlowlyLit> expected = lamps_slowly(ldi, lens, lamps, places);

    const BlockFootprints footprints(ldi, samples, Links(ldi, lens));
    const BlockFootprints solid_footprints(ldi, lit.solids);
    HighlightTile tile(lit, {{samples, footprints}, {lit.solids, solid_footprints}});
    std::vector<std::uint32_t> blocks(samples.blocks.size());
    std::iota(blocks.begin(), blocks.end(), 0u);
    tile.spread({0, 0}, blocks);

    // For a rim pixel, the tile multiplies the share inside the disc by the lit share, an error of at most a quarter.
    // Each of its shares is measured with 64 points, eight in a row: an edge that crosses them is off by a sixteenth,
    // and so is the other edge of the object that hides the lamp. The errors have either sign.
    const double bright = 900 / (std::numbers::pi * c.lamp_coc * c.lamp_coc * c.aspect);
    // Near the focus the tile uses cells of the lens, 1/32 of it wide, with 64 points each; the slow way uses 128
    // points along the lens. An edge that hides the lamp is off by half a point, and two objects may hide a lamp at
    // each side: 2 %.
    const bool near_focus = std::abs(c.lamp_coc) < 2;
    constexpr double in_cells = 0.02;
    double squares = 0, sum = 0, expected_sum = 0, unhidden = 0;
    for (std::size_t p = 0; p < expected.size(); ++p) {
        const Imath::V2i at = ldi.windows.pixel(p);
        const double red = double(tile.value(at.x, at.y, red_channel)), off = red - expected[p].light[0];
        EXPECT_NEAR(double(tile.value(at.x, at.y, 1)), red * 2 / 3, 1e-5 * bright);
        EXPECT_NEAR(expected[p].light[1], expected[p].light[0] * 2 / 3, 1e-5 * bright);
        const Discs discs = discs_at(c, at);
        EXPECT_LE(std::abs(off), near_focus
                                     ? 900 * in_cells
                                     : (discs.rims * (0.25 + 0.125) + discs.whole * 0.125) * bright + 1e-6)
            << at;
        squares += off * off;
        sum += red;
        expected_sum += expected[p].light[0];
        unhidden += expected[p].unhidden;
    }
    EXPECT_LE(std::sqrt(squares / double(expected.size())), bright / 32);
    EXPECT_NEAR(sum, expected_sum, 0.01 * expected_sum);
    EXPECT_NEAR(unhidden, 3 * 900 * (c.lamps_partial ? 0.5 : 1), 10); // all discs are inside the picture
    EXPECT_LE(expected_sum, (c.hidden ? 0.9 : 1) * unhidden);
}

const Case cases[] = {
    {"WithNothingBeforeThem", 8.3, 9.5, 0, 0, 1, false, false},
    {"BehindBoards", 8.3, 3},
    {"BehindBoardsInFrontOfFocus", 8.3, -4},
    {"AllInFrontOfFocus", -5.3, -8},
    {"BehindThinBoards", 8.3, 3, 0.7},
    {"BehindALeaningSurface", 8.3, 1, 0, 0.12},
    {"BehindASteepSurface", 8.3, -16, 0, 1.6},
    {"OfPartialCoverage", 8.3, 3, 0.3, 0, 1, true},
    {"OfPixelsTwiceAsHigh", 6.3, 2, 0.2, 0, 2},
    {"OfAFewPixels", 2.6, -4},
    {"AlmostInFocus", 1.4, -7, 0.3},
    {"AlmostInFocusInFront", -1.3, -8},
    {"BehindBoardsHardlyBefore", 1.8, 1.7, 0, 0, 1, false, true, 0.5},
    {"BehindBoardsHardlyBeforeAndBlurred", 5.3, 5.2, 0, 0, 1, false, true, 0.5},
    {"InFocus", 0.2, -9, 0, 0, 2},
};

INSTANTIATE_TEST_SUITE_P(Scenes, LampsSlowly, testing::ValuesIn(cases),
                         [](const auto &c) { return c.param.name; });

} // namespace
} // namespace sparselens
