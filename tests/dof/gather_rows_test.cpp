#include "deep/tidy.h"
#include "dof/border_reach.h"
#include "dof/gather_rows.h"
#include "support/deep_scenes.h"
#include "support/ldi_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace sparselens {
namespace {

constexpr int width = 16, height = 500, lamps_apart = 37;

PackedRows packed(const Ldi &ldi) {
    PackedRows rows(ldi.windows);
    rows.append(ldi);
    return rows;
}

// Interrupted stairs, hair, holes, small lamps, and strips that are hardly lamps: gives links, partial samples, fillers
// and highlights.
std::vector<Sample> scene(int x, int y) {
    const auto random = [&](std::uint32_t stream) { return float(random_unit(x, y, stream)); };
    std::vector<Sample> samples;
    const auto add = [&](double z, float alpha, float light) {
        samples.push_back({.z = z,
                           .values = {light * alpha, 0.5f * light * alpha, random(4) * alpha, alpha},
                           .dx = random(5) - 0.5f,
                           .dy = random(6) - 0.5f});
    };
    const bool lamp = x == 11 && y % lamps_apart == 20, strip = y / 40 % 4 == 1 && x % 2 == 0;
    if (random(1) < 0.3f) add(3 + 0.1 * double(random(2)), 0.2f + 0.5f * random(3), 0.4f);
    if ((x / 6 + y / 10) % 3 == 0) add(4 + 0.02 * (y % 10), 1, 0.3f + 0.3f * random(7));
    if (y / 40 % 5 != 3)
        add(8 + 0.5 * std::sin(0.2 * y), 1,
            lamp    ? 500.0f
            : strip ? 8.0f
                    : 0.5f + 0.2f * std::sin(0.9f * float(x + y)));
    return samples;
}

class GatherRows : public testing::Test {
protected:
    Ldi ldi = make_ldi(windows_of_size(width, height), rgba_channels(), scene);
    ThinLens lens{.radius = 0.6, .focal_px = 40, .focus = 5};
    PictureOptions options;
    Imath::Box2i window{{0, 0}, {width - 1, height - 1}};
    LensTiles tiles;
    Progress progress;

    void SetUp() override {
        options.gather.lens.quality = Quality::draft;
        options.gather.lens.chosen = &tiles;
    }
    // Compares bands of one row of tiles with all rows at once.
    void expect_same(const Imath::Box2i &written) {
        const Image whole = gather_picture(ldi, lens, window, written, options, progress);
        const std::vector<int> chosen = tiles.lens_points;
        const Image banded = gather_rows(packed(ldi), lens, window, written, options, {0, true}, progress);
        EXPECT_EQ(banded.windows, whole.windows);
        EXPECT_EQ(banded.channels, whole.channels);
        EXPECT_TRUE(banded.values == whole.values);
        EXPECT_EQ(tiles.lens_points, chosen);
    }
};

TEST_F(GatherRows, OneRowOfTilesAtATimeGivesTheSameBits) {
    const RowReach reach = reach_of(packed(ldi), lens, {});
    EXPECT_LT(64 + 2 * (reach.seen + reach.prepared), height); // otherwise a band needs all rows
    expect_same(window);
    EXPECT_GT(*std::ranges::max_element(tiles.lens_points), 0);
}

TEST_F(GatherRows, BlurFarWiderThanTheCellsAroundIsTheSame) {
    constexpr int higher = 1500;
    ldi = make_ldi(windows_of_size(8, higher), rgba_channels(), scene);
    lens.radius = 30; // CoCs up to 240 pixels
    const RowReach reach = reach_of(packed(ldi), lens, {});
    for (const int first : {0, higher - 128}) {
        window = {{0, first}, {7, first + 127}};
        EXPECT_LT(128 + reach.seen + reach.prepared, higher); // otherwise a band needs all rows
        expect_same(window);
    }
}

TEST_F(GatherRows, MemoryThatIsEnoughTakesAllRowsAtOnce) {
    const Image whole = gather_picture(ldi, lens, window, window, options, progress);
    EXPECT_TRUE(gather_rows(packed(ldi), lens, window, window, options, {1e12}, progress).values ==
                whole.values);
    EXPECT_TRUE(gather_rows(packed(ldi), lens, window, window, options, {4e5, true}, progress).values ==
                whole.values);
    EXPECT_TRUE(gather_rows(packed(ldi), lens, window, window, options, {0}, progress).values ==
                whole.values);
}

TEST_F(GatherRows, APartOfThePictureIsThatOfTheWhole) {
    window = {{2, 30}, {width - 3, height - 20}};
    expect_same({{4, 180}, {width - 5, 300}});
}

// A bar that the frame cuts off ends as another one does, 92 rows of the picture away, which are 276 rows of the LDI.
TEST_F(GatherRows, SubPixelsKnowAsManyRowsOfThePictureAtTheFrame) {
    ldi = make_ldi(windows_of_size(width, height), rgba_channels(), [](int x, int y) {
        const int from_frame = x < width / 2 ? y : height - 1 - y;
        const bool bar = from_frame / 6 == 0 || from_frame / 6 == 46;
        return std::vector<Sample>{{.z = bar ? 4.0 : 8.0, .values = {bar ? 0.1f : 0.8f, 0.4f, 0.3f, 1}}};
    });
    options.gather.lens.across = 3;
    const RowReach reach = reach_of(packed(ldi), lens, {}, 3);
    EXPECT_LT(64 + reach.seen + reach.prepared, 276);
    expect_same(window);
}

TEST_F(GatherRows, SharpenedRowsAreTheSame) {
    lens.focus = 8; // near the far wall
    expect_same(window);
}

TEST_F(GatherRows, LooksThatKeepThePlaneOfFocusAreTheSame) {
    options.gather.lens.looks.chromatic_coc = {0.4, 0, -0.3};
    options.gather.lens.looks.aperture.blades = 6;
    expect_same(window);
}

TEST_F(GatherRows, ABentPlaneOfFocusIsTheSame) {
    options.gather.lens.looks.field_curvature = 0.1;
    expect_same(window);
    options.gather.lens.looks = {.astigmatism = 0.5};
    expect_same(window);
}

TEST_F(GatherRows, PerChannelAlphaIsTheSame) {
    ldi.channels = {{"R"}, {"G"}, {"B"}, {"A"}, {"AR"}, {"AG"}, {"AB"}};
    ldi.values.resize(7, ldi.values[3]);
    for (float &alpha : ldi.values[4])
        if (alpha < 1) alpha *= 0.7f;
    expect_same(window);
}

TEST_F(GatherRows, ImagesOfMirrorsAreTheSame) {
    ldi.image_z = ldi.z;
    for (std::size_t i = 0; i < ldi.image_z.size(); i += 3) ldi.image_z[i] *= 1.5f;
    expect_same(window);
}

TEST_F(GatherRows, WhatIsSolidIsTheSame) {
    ldi.solid.assign(ldi.samples(), 0);
    for (std::size_t i = 0; i < ldi.solid.size(); i += 2) ldi.solid[i] = 0.2f / ldi.z[i];
    expect_same(window);
}

TEST_F(GatherRows, LampsThatMoveAreTheSame) {
    std::vector<LampPart> lamps, in_bands;
    options.gather.lens.lamps = &lamps;
    gather_picture(ldi, lens, window, window, options, progress);
    options.gather.lens.lamps = &in_bands;
    gather_rows(packed(ldi), lens, window, window, options, {0, true}, progress);
    ASSERT_FALSE(lamps.empty());
    for (const LampPart &part : lamps) EXPECT_NE(std::ranges::find(in_bands, part), in_bands.end());
    for (const LampPart &part : in_bands) EXPECT_NE(std::ranges::find(lamps, part), lamps.end());
    options.gather.lens.lamps = nullptr;
    LampPaths paths;
    for (const LampPart &part : lamps)
        if (part.light[0] > 100 && part.at.y > 150 && part.at.y < 300) paths.add(part, {{3, 800}, {0, 9}});
    paths.sort();
    const Image resting = gather_picture(ldi, lens, window, window, options, progress);
    options.gather.lens.paths = &paths;
    EXPECT_NE(resting.values, gather_picture(ldi, lens, window, window, options, progress).values);
    expect_same(window);
}

TEST_F(GatherRows, LayersAreMergedAsTheyAreAtOnce) {
    ldi = tidy(
        random_ldi({.seed = 3, .width = width, .height = height, .most_samples = 8, .opaque_share = 0.2}));
    lens.radius = 0.1;
    expect_same(window);
}

// Wide enough that in cells some lens points look farther beyond the frame at one layer than at the merged ones.
TEST_F(GatherRows, LayersAreMergedAtOnceAsTheyAreWhileTheyAreRead) {
    constexpr int wide = 24;
    const auto dense = std::ranges::find(deep_scenes(), std::string_view("dense"), &DeepScene::name);
    ldi = dense->make(wide, 300);
    window = ldi.windows.data;
    lens = {.radius = 6, .focal_px = wide * 50 / 36.0, .focus = 1.3};
    const Image at_once = gather_picture(ldi, lens, window, window, options, progress);
    PictureOptions merged = options;
    merged.layer_tolerance = 0;
    EXPECT_TRUE(
        gather_picture(reduced_first(ldi, lens, options), lens, window, window, merged, progress).values ==
        at_once.values);
    EXPECT_LT(reduced_first(ldi, lens, options).samples(), ldi.samples());
}

TEST_F(GatherRows, TheBorderKnowsHowFarTheBlurReaches) {
    const BorderReach whole = border_reach(ldi, lens), by_rows = border_reach(border_of(packed(ldi)), lens);
    EXPECT_GT(whole.needed, 0);
    EXPECT_EQ(by_rows.needed, whole.needed);
    EXPECT_EQ(by_rows.rendered, whole.rendered);
    EXPECT_EQ(by_rows.bright, whole.bright);
    EXPECT_LT(border_of(packed(ldi)).samples(), ldi.samples() / 4);
}

} // namespace
} // namespace sparselens
