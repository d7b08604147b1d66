#include "deep/flatten.h"
#include "deep/merge.h"
#include "deep/tidy.h"
#include "support/composite.h"
#include "support/ldi_samples.h"

#include <gtest/gtest.h>

#include <array>

namespace sparselens {
namespace {

TEST(DeepMerge, SamplesOfAllPartsLieInTheWindowThatHoldsThemAll) {
    Ldi left = ldi_of({{{.z = 2, .colour = 0.5f}}, {{.z = 3}}}), right = ldi_of({{{.z = 1}, {.z = 4}}, {}});
    left.windows.data = Imath::Box2i({0, 0}, {1, 0});
    right.windows.data = Imath::Box2i({1, 0}, {1, 1});
    const Ldi both = deep_merge({left, right});
    EXPECT_EQ(both.windows.display, left.windows.display);
    EXPECT_EQ(both.windows.data, Imath::Box2i({0, 0}, {1, 1}));
    EXPECT_EQ(both.begin, (std::vector<std::uint64_t>{0, 1, 4, 4, 4}));
    EXPECT_EQ(both.z, (std::vector<float>{2, 3, 1, 4}));
    EXPECT_EQ(both.values[0], (std::vector<float>{0.5f, 1, 1, 1}));
    EXPECT_EQ(tidy(both).z, (std::vector<float>{2, 1, 3, 4}));
}

TEST(DeepMerge, WhatAPartDoesNotHaveIsNothingThere) {
    Ldi a = ldi_of({{{.z = 2, .colour = 3, .alpha = 0.5f}}}),
        b = ldi_of({{{.z = 1, .z_back = 1.5f, .weight = 4, .dx = 0.25f}}});
    a.channels = {{"R"}, {"G"}, {"B"}, {"A"}};
    a.dx = a.dy = a.weight = {};
    b.channels = {{"R", PixelType::float32}, {"N.x"}, {"id", PixelType::uint32}, {"AR"}};
    b.values = {{7}, {8}, {9}, {0.125f}};
    const Ldi both = deep_merge({a, b});
    const std::vector<Channel> all{{"R", PixelType::float32}, {"G"}, {"B"}, {"A"}, {"N.x"},
                                   {"id", PixelType::uint32}, {"AR"}};
    EXPECT_EQ(both.channels, all);
    EXPECT_EQ(both.z_back, (std::vector<float>{2, 1.5f}));
    EXPECT_EQ(both.dx, (std::vector<float>{0, 0.25f}));
    EXPECT_EQ(both.weight, (std::vector<float>{1, 4}));
    const std::vector<std::vector<float>> values{{3, 7}, {1.5f, 0}, {0.75f, 0}, {0.5f, 1},
                                                 {0, 8}, {0, 9},    {0, 0.125f}};
    EXPECT_EQ(both.values, values);
}

TEST(DeepMerge, WithoutColouredAlphaAPartCoversAllColoursAlike) {
    Ldi a = ldi_of({{{.z = 2, .alpha = 0.5f}}}), b = a;
    b.channels = {{"R"}, {"AR"}, {"AG"}, {"AB"}};
    b.values = {{1}, {0.125f}, {0.25f}, {0.75f}};
    const Ldi both = deep_merge({a, b});
    for (const auto &[name, value] : {std::pair("AR", 0.125f), {"AG", 0.25f}, {"AB", 0.75f}})
        EXPECT_EQ(both.values[find_channel(both.channels, name)], (std::vector<float>{0.5f, value})) << name;
}

// Samples of an object cut out of a whole and put back give the whole.
TEST(DeepMerge, OfDisjointSamplesIsTheWhole) {
    const Ldi whole = tidy(random_ldi({.width = 20, .height = 10}));
    std::array<std::vector<TestPixel>, 2> parts;
    for (std::size_t pixel = 0; pixel < whole.windows.pixels(); ++pixel) {
        for (auto &part : parts) part.emplace_back();
        for (const TestSample &s : samples_of(whole, pixel)) parts[s.z > 5 ? 1 : 0].back().push_back(s);
    }
    std::vector<Ldi> ldis;
    for (const auto &part : parts) {
        ldis.push_back(ldi_of(part));
        ldis.back().windows = whole.windows;
    }
    const Image expected = flatten(whole), picture = flatten(tidy(deep_merge(ldis)));
    EXPECT_EQ(picture.values, expected.values);
}

TEST(DeepMerge, LayersHaveTheSameSamples) {
    Ldi beauty = ldi_of({{{.z = 1}, {.z = 2}}}), diffuse = beauty;
    diffuse.channels = {{"R"}, {"N.x"}, {"G"}, {"A"}};
    beauty.channels.push_back({"diffuse.A"});
    beauty.values.push_back({5, 5});
    EXPECT_TRUE(same_samples(beauty, diffuse));
    diffuse.dx = diffuse.dy = {};
    beauty.dx = beauty.dy = {0.25f, 0.125f};
    EXPECT_TRUE(same_samples(diffuse, beauty));
    EXPECT_FALSE(same_samples(beauty, diffuse));
    beauty.dx = beauty.dy = {};
    add_layer(beauty, diffuse, "diffuse");
    const std::vector<Channel> all{{"R"},         {"G"},         {"B"},   {"A"},
                                   {"diffuse.A"}, {"diffuse.R"}, {"N.x"}, {"diffuse.G"}};
    EXPECT_EQ(beauty.channels, all);
    EXPECT_EQ(beauty.values[4], (std::vector<float>{5, 5}));
    EXPECT_EQ(beauty.values[6], diffuse.values[1]);
    diffuse.z[1] = 3;
    EXPECT_FALSE(same_samples(beauty, diffuse));
}

TEST(DeepMerge, WhatHasNoImageLiesWhereItIs) {
    Ldi mirror = ldi_of({{{.z = 2}}});
    const Ldi wall = ldi_of({{{.z = 3}}});
    mirror.image_z = {7};
    EXPECT_EQ(deep_merge({mirror, wall}).image_z, (std::vector<float>{7, 3}));
    EXPECT_TRUE(deep_merge({wall, wall}).image_z.empty());
    Ldi shuffled = ldi_of({{{.z = 4}, {.z = 3}}, {{.z = 2, .colour = 0, .alpha = 0}, {.z = 5}}});
    shuffled.image_z = {40, 30, 20, 50};
    EXPECT_EQ(tidy(shuffled).image_z, (std::vector<float>{30, 40, 50}));
    EXPECT_FALSE(same_samples(mirror, ldi_of({{{.z = 2}}})));
}

} // namespace
} // namespace sparselens
