#include "deep/flatten.h"
#include "deep/tidy.h"
#include "dof/gather_picture.h"
#include "dof/merge_layers.h"
#include "measure/image_error.h"
#include "support/deep_scenes.h"
#include "support/ldi_samples.h"
#include "support/lens_ldi.h"
#include "support/order.h"
#include "view/resolve_lens.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace sparselens {
namespace {

// A point at this disparity (for a scale of 1).
TestSample at(double depth, float alpha, float colour = 0.25f) {
    return {.z = float(1 / depth), .colour = colour, .alpha = alpha};
}

TestPixel merged(const TestPixel &pixel, double tolerance) {
    return samples_of(merge_layers(ldi_of({pixel}), 1, tolerance), 0);
}

TEST(MergeLayers, TwoLayersAreOneByWhatTheyShow) {
    const TestPixel two = merged({at(5, 0.5f, 0.25f), at(4.9, 0.5f, 0.5f)}, 0.25);
    ASSERT_EQ(two.size(), 1u);
    EXPECT_FLOAT_EQ(two[0].alpha, 0.75f);
    EXPECT_FLOAT_EQ(two[0].colour, 0.25f + 0.5f * 0.5f);
    EXPECT_NEAR(1 / double(two[0].z), (0.5 * 5 + 0.25 * 4.9) / 0.75, 1e-6);
}

TEST(MergeLayers, LayersFartherApartStay) {
    EXPECT_EQ(merged({at(5, 0.5f), at(4.7, 0.5f)}, 0.25).size(), 2u);
    // From the front, so that no run is longer than the tolerance.
    EXPECT_EQ(merged({at(5, 0.1f), at(4.9, 0.1f), at(4.8, 0.1f), at(4.7, 0.1f), at(4.6, 0.1f)}, 0.25).size(),
              2u);
    EXPECT_EQ(merged({at(5, 0.5f), at(4.999, 0.5f)}, 0).size(), 2u);
}

TEST(MergeLayers, ImagesFartherApartStay) {
    Ldi ldi = ldi_of({{at(5, 0.5f), at(4.95, 0.5f)}});
    ldi.image_z = {1 / 2.0f, 1 / 2.5f};
    EXPECT_EQ(merge_layers(ldi, 1, 0.25).image_z, ldi.image_z);
    const Ldi one = merge_layers(ldi, 1, 0.6);
    ASSERT_EQ(one.samples(), 1u);
    EXPECT_NEAR(1 / one.coc_z(0), (0.5 * 2 + 0.25 * 2.5) / 0.75, 1e-6);
}

TEST(MergeLayers, PositionsFartherApartStay) {
    TestPixel pixel{at(5, 0.5f), at(4.95, 0.5f)};
    pixel[0].dx = -0.2f;
    pixel[1].dx = 0.2f;
    EXPECT_EQ(merged(pixel, 0.25).size(), 2u);
    const TestPixel one = merged(pixel, 0.5);
    ASSERT_EQ(one.size(), 1u);
    EXPECT_NEAR(double(one[0].dx), (-0.2 * 0.5 + 0.2 * 0.25) / 0.75, 1e-6);
}

TEST(MergeLayers, WhatLiesBehindAnOpaqueSampleStays) {
    const TestPixel pixel = merged({at(5, 0.5f), at(4.95, 1), at(4.9, 0.5f), at(4.85, 1)}, 0.25);
    ASSERT_EQ(pixel.size(), 2u);
    EXPECT_FLOAT_EQ(pixel[0].alpha, 1);
    EXPECT_FLOAT_EQ(pixel[1].alpha, 1);
}

TEST(MergeLayers, FlattenedPictureIsTheSameAndTheSamplesAreTidy) {
    const Ldi ldi =
        tidy(random_ldi({.seed = 7, .width = 40, .height = 30, .opaque_share = 0.2, .depths = 64}));
    for (const double tolerance : {0.05, 0.5, 100.0}) {
        const Ldi merged = merge_layers(ldi, 4, tolerance);
        EXPECT_LT(merged.samples(), ldi.samples());
        EXPECT_TRUE(order_of(merged).sorted && order_of(merged).apart);
        EXPECT_LT(largest_difference(flatten(merged), flatten(ldi)), 1e-5);
    }
}

TEST(MergeLayers, WhereThereIsNothingToMergeAllButExtentsAndWeightsStays) {
    Ldi ldi = ldi_of({{at(5, 0.5f), at(1, 1)}, {at(3, 1)}});
    ldi.weight = {1, 2, 3};
    const Ldi out = merge_layers(ldi, 1, 0.25);
    EXPECT_EQ(out.z, ldi.z);
    EXPECT_EQ(out.values, ldi.values);
    EXPECT_TRUE(out.z_back.empty() && out.weight.empty());
}

TEST(MergeLayers, CryptomattesAndPerChannelAlphaAreLeftAlone) {
    Ldi ldi = ldi_of({{at(5, 0.5f), at(4.9, 0.5f)}});
    ldi.channels.push_back({"AR"});
    ldi.values.push_back({0.5f, 0.25f});
    ldi.channels.push_back({"AG"});
    ldi.values.push_back({0.5f, 0.5f});
    ldi.channels.push_back({"AB"});
    ldi.values.push_back({0.5f, 0.5f});
    EXPECT_EQ(merge_layers(ldi, 1, 0.25).samples(), 2u);
    Ldi matte = ldi_of({{at(5, 0.5f), at(4.9, 0.5f)}});
    matte.channels[0].kind = ChannelKind::matte_id;
    EXPECT_EQ(merge_layers(matte, 1, 0.25).samples(), 2u);
}

// A picture of an LDI through a lens of R F 20, with layers merged by the tolerance.
Image through_a_lens(const Ldi &ldi, double tolerance) {
    const ThinLens lens{.radius = 0.02, .focal_px = 1000, .focus = 5};
    const Imath::Box2i &all = ldi.windows.data;
    PictureOptions options;
    options.layer_tolerance = tolerance;
    Progress silent;
    return gather_picture(ldi, lens, all, all, options, silent);
}

TEST(MergeLayers, LightBesideCryptomattesIsMergedAndTheMattesAreNot) {
    Ldi ldi = tidy(random_ldi({.seed = 9, .width = 40, .height = 30, .depths = 64}));
    const std::size_t first = ldi.channels.size();
    for (const char *name : {"crypto00.R", "crypto00.G"}) ldi.channels.push_back({name, PixelType::float32});
    find_kinds(ldi.channels);
    ASSERT_TRUE(is_in_matte(ldi.channels[first]));
    std::vector<float> ids(ldi.samples());
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = float(1 + i % 3);
    ldi.values.push_back(ids);
    ldi.values.push_back(ldi.values[ldi.alpha()]);
    const Image whole = through_a_lens(ldi, 0), merged = through_a_lens(ldi, 2);
    const auto equal = [&](std::size_t k) { return std::ranges::equal(whole.plane(k), merged.plane(k)); };
    EXPECT_TRUE(equal(first) && equal(first + 1));
    EXPECT_FALSE(equal(0));
}

TEST(MergeLayers, LightOfEachCoverageIsMergedAsIfItWereAlone) {
    Ldi ldi = tidy(random_ldi({.seed = 10, .width = 40, .height = 30, .depths = 64}));
    Ldi blue = ldi;
    for (const char *name : {"AR", "AG", "AB"}) {
        ldi.channels.push_back({name});
        ldi.values.push_back(ldi.values[ldi.alpha()]);
    }
    for (float &a : ldi.values.back()) a *= 0.5f;
    blue.values[blue.alpha()] = ldi.values.back();
    EXPECT_FALSE(can_merge_layers(ldi));
    const Image merged = through_a_lens(ldi, 2), of_blue = through_a_lens(blue, 2);
    const std::size_t b = find_channel(ldi.channels, "B");
    EXPECT_TRUE(std::ranges::equal(merged.plane(b), of_blue.plane(b)));
    EXPECT_FALSE(std::ranges::equal(merged.plane(b), through_a_lens(ldi, 0).plane(b)));
}

TEST(MergeLayers, SamplesThatAreReducedFirstMakeTheSamePicture) {
    const Ldi ldi =
        tidy(random_ldi({.seed = 11, .width = 40, .height = 30, .opaque_share = 0.2, .depths = 64}));
    for (const double radius : {0.0, 0.5}) {
        const ThinLens lens{radius, 40, 3};
        Progress silent;
        PictureOptions options;
        const Imath::Box2i &all = ldi.windows.data;
        const Image picture = gather_picture(ldi, lens, all, all, options, silent);
        const Ldi fewer = reduced_first(ldi, lens, options);
        EXPECT_LT(fewer.samples(), ldi.samples());
        options.layer_tolerance = 0;
        EXPECT_EQ(gather_picture(fewer, lens, all, all, options, silent).values, picture.values);
    }
}

// The bound of lab/results/techniques.md, which decides whether layers are merged at all.
TEST(MergeLayers, DenseScenesLookTheSame) {
    for (const DeepScene &scene : deep_scenes()) {
        const Ldi ldi = tidy(scene.make(32, 24));
        const ThinLens lens = resolve_lens(deep_scene_camera(32), ldi.windows);
        Progress silent;
        const auto picture = [&](double tolerance) {
            PictureOptions options;
            options.layer_tolerance = tolerance;
            const Imath::Box2i &all = ldi.windows.data;
            return gather_picture(ldi, lens, all, all, options, silent);
        };
        const Image whole = picture(0), merged = picture(layer_tolerance_px);
        // Their layers are farther apart than the tolerance, so nothing may change.
        if (scene.name == std::string("hair") || scene.name == std::string("apart")) {
            EXPECT_EQ(merged.values, whole.values) << scene.name;
            continue;
        }
        const double decibels = image_error(merged, whole)[0].psnr_tonemapped;
        EXPECT_GT(decibels, 45) << scene.name;
        EXPECT_TRUE(std::isfinite(decibels)) << scene.name; // otherwise nothing was merged
    }
}

} // namespace
} // namespace sparselens
