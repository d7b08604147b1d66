#include "deep/cluster.h"
#include "deep/flatten.h"
#include "deep/tidy.h"
#include "support/ldi_samples.h"
#include "support/order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

Clustered clustered(const Ldi &ldi, const ClusterOptions &options) {
    Progress silent;
    return cluster(ldi, options, silent);
}

TestPixel clustered(const TestPixel &pixel, const ClusterOptions &options) {
    return samples_of(clustered(ldi_of({pixel}), options).ldi, 0);
}

// Points at these disparities (for a scale of 1), front to back.
TestPixel at_depths(std::initializer_list<double> depths, const TestSample &like = {.z = 1}) {
    TestPixel pixel;
    for (const double depth : depths) {
        pixel.push_back(like);
        pixel.back().z = float(1 / depth);
    }
    return pixel;
}

std::vector<double> depths_of(const Ldi &ldi, std::size_t pixel, double scale) {
    std::vector<double> depths;
    for (const TestSample &s : samples_of(ldi, pixel)) depths.push_back(scale / double(s.z));
    return depths;
}

// The fewest runs of at most `extent`, and the smallest extent for at most `layers` runs, found by trying all ways to
// cut the sorted depths into runs.
struct BruteForce {
    std::size_t fewest = SIZE_MAX;
    double smallest_extent = inf;

    BruteForce(const std::vector<double> &depths, double extent, std::size_t layers) {
        const std::size_t n = depths.size();
        for (std::size_t cuts = 0; cuts < std::size_t(1) << (n - 1); ++cuts) {
            double widest = 0;
            std::size_t runs = 1, first = 0;
            for (std::size_t i = 0; i < n; ++i) {
                if (i > 0 && (cuts >> (i - 1) & 1)) {
                    first = i;
                    ++runs;
                }
                widest = std::max(widest, depths[first] - depths[i]);
            }
            if (widest <= extent) fewest = std::min(fewest, runs);
            if (runs <= layers) smallest_extent = std::min(smallest_extent, widest);
        }
    }
};

TEST(Cluster, WithoutToleranceAndLimitNothingChanges) {
    const Ldi ldi = random_ldi({.volume_share = 0.3});
    const Ldi neat = tidy(ldi);
    const Clustered out = clustered(neat, {});
    EXPECT_EQ(out.largest_error, 0);
    EXPECT_EQ(out.ldi.begin, neat.begin);
    EXPECT_EQ(out.ldi.z, neat.z);
    EXPECT_EQ(out.ldi.z_back, neat.z_back);
    EXPECT_EQ(out.ldi.dx, neat.dx);
    EXPECT_EQ(out.ldi.weight, neat.weight);
    EXPECT_EQ(out.ldi.values, neat.values);
}

TEST(Cluster, TheNearerOpaqueSampleHidesTheFarther) {
    const TestPixel two{{.z = 4, .colour = 1, .weight = 3, .dx = 0.25f, .dy = -0.5f},
                        {.z = 4.1f, .colour = 5, .weight = 1, .dx = -0.25f, .dy = 0.5f}};
    const TestPixel p = clustered(two, {.scale = 10, .tolerance = 0.25});
    ASSERT_EQ(p.size(), 1u);
    EXPECT_EQ(p[0].colour, 1);
    EXPECT_EQ(p[0].alpha, 1);
    EXPECT_EQ(p[0].weight, 3);
    EXPECT_EQ(p[0].dx, 0.25f);
    EXPECT_EQ(p[0].dy, -0.5f);
    EXPECT_EQ(p[0].z, 4);
    EXPECT_EQ(clustered(two, {.scale = 100, .tolerance = 0.25}).size(), 2u); // now 0.6 px apart
}

// With K layers a wall far behind joins the cluster of the sample that hides it, without mixing in.
TEST(Cluster, WhatAnOpaqueSampleHidesIsNotMixedIn) {
    const TestPixel p = clustered({{.z = 2, .colour = 1}, {.z = 20, .colour = 100}}, {.layers = 1});
    ASSERT_EQ(p.size(), 1u);
    EXPECT_EQ(p[0].colour, 1);
    EXPECT_EQ(p[0].z, 2);
    EXPECT_EQ(p[0].weight, 1);
}

TEST(Cluster, PartialCoverageIsComposited) {
    const TestPixel veils{{.z = 2, .colour = 0.5f, .alpha = 0.5f, .dx = 0.5f},
                          {.z = 3, .colour = 1, .alpha = 0.25f, .dx = -0.5f}};
    const TestPixel p = clustered(veils, {.layers = 1});
    ASSERT_EQ(p.size(), 1u);
    EXPECT_FLOAT_EQ(p[0].colour, 1);
    EXPECT_FLOAT_EQ(p[0].alpha, 0.625f);
    EXPECT_FLOAT_EQ(p[0].dx, 0.3f); // visible shares: 0.5 of one, 0.125 of the other
    EXPECT_FLOAT_EQ(p[0].z, float(0.625 / (0.5 / 2 + 0.125 / 3)));
    EXPECT_EQ(p[0].weight, 2);
}

TEST(Cluster, AVolumeAmongPointsMakesAVolume) {
    const TestPixel mixed{{.z = 1, .alpha = 0.1f},
                          {.z = 2, .alpha = 0.1f, .z_back = 3},
                          {.z = 4, .alpha = 0.1f},
                          {.z = 400, .alpha = 0.1f},
                          {.z = 500, .alpha = 0.1f}};
    const TestPixel p = clustered(mixed, {.layers = 2});
    ASSERT_EQ(p.size(), 2u);
    EXPECT_EQ(p[0].z, 1);
    EXPECT_EQ(p[0].z_back, 1); // the sample farthest from the rest in disparity stays alone
    EXPECT_EQ(p[1].z, 2);
    EXPECT_EQ(p[1].z_back, 500);
    const TestPixel points = clustered(
        TestPixel{{.z = 1, .alpha = 0.1f, .z_back = 2}, {.z = 30, .alpha = 0.1f}, {.z = 40, .alpha = 0.1f}},
        {.layers = 2});
    EXPECT_EQ(points[1].z, points[1].z_back); // points stay points, also in a file with volumes
}

// An opaque volume may be deeper than the tolerance. It is the whole of its cluster, or lies behind veils.
TEST(Cluster, AnOpaqueVolumeDeeperThanTheToleranceStays) {
    const TestSample volume{.z = 2, .z_back = 40}, veil{.z = 1.999f, .alpha = 0.5f};
    const TestPixel alone = clustered(TestPixel{volume}, {.tolerance = 0.01});
    ASSERT_EQ(alone.size(), 1u);
    EXPECT_EQ(alone[0].z_back, 40);
    const TestPixel behind_veil = clustered(TestPixel{veil, volume}, {.layers = 1});
    ASSERT_EQ(behind_veil.size(), 1u);
    EXPECT_EQ(behind_veil[0].z_back, 40);
    EXPECT_EQ(behind_veil[0].alpha, 1);
}

TEST(Cluster, MakesAsFewAsCanBeWithinTheTolerance) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed)
        for (const double tolerance : {0.01, 0.05, 0.2}) {
            const Ldi ldi = tidy(random_ldi({.seed = seed, .most_samples = 9}));
            const Clustered out = clustered(ldi, {.scale = 2, .tolerance = tolerance});
            EXPECT_LE(out.largest_error, tolerance);
            for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel) {
                const std::vector<double> in = depths_of(ldi, pixel, 2);
                ASSERT_EQ(samples_of(out.ldi, pixel).size(),
                          in.empty() ? 0 : BruteForce(in, tolerance, 0).fewest);
            }
        }
}

TEST(Cluster, AtMostKLayersWithTheLeastExtent) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed)
        for (const int layers : {1, 2, 3, 5}) {
            const Ldi ldi = tidy(random_ldi({.seed = seed, .width = 1, .height = 1, .most_samples = 10}));
            const std::vector<double> in = depths_of(ldi, 0, 7);
            if (in.empty()) continue;
            const Clustered out = clustered(ldi, {.scale = 7, .layers = layers});
            EXPECT_LE(out.ldi.samples(), std::size_t(layers));
            EXPECT_NEAR(out.largest_error, BruteForce(in, 0, std::size_t(layers)).smallest_extent, 1e-5);
        }
}

// A pixel with at most K clusters within the tolerance is not merged further; one with more is.
TEST(Cluster, ToleranceAndLayersTogether) {
    const ClusterOptions options{.tolerance = 0.1, .layers = 2};
    EXPECT_EQ(clustered(at_depths({1, 0.95, 0.5}), options).size(), 2u);
    EXPECT_EQ(clustered(at_depths({1, 0.8, 0.5}), options).size(), 2u);
    EXPECT_EQ(clustered(at_depths({1, 0.8}), options).size(), 2u);
    EXPECT_EQ(clustered(at_depths({1, 0.95}), options).size(), 1u);
}

TEST(Cluster, NoSampleIsFurtherFromItsClusterThanIsSaid) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed)
        for (const ClusterOptions &options :
             {ClusterOptions{.scale = 5, .tolerance = 0.3}, ClusterOptions{.scale = 5, .layers = 2},
              ClusterOptions{.scale = 5, .tolerance = 0.1, .layers = 3}}) {
            const Ldi ldi = tidy(random_ldi({.seed = seed, .opaque_share = 0.3}));
            const Clustered out = clustered(ldi, options);
            EXPECT_TRUE(order_of(out.ldi).sorted && order_of(out.ldi).apart);
            double largest = 0;
            for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel) {
                const std::vector<double> after = depths_of(out.ldi, pixel, options.scale);
                for (const double before : depths_of(ldi, pixel, options.scale)) {
                    double nearest = inf;
                    for (const double depth : after) nearest = std::min(nearest, std::abs(depth - before));
                    largest = std::max(largest, nearest);
                }
            }
            EXPECT_LE(largest, out.largest_error);
            EXPECT_GE(largest, out.largest_error / 4); // the bound is tight
        }
}

TEST(Cluster, FlattensToWhatItDidBefore) {
    for (const double volumes : {0.0, 0.4})
        for (const double opaque : {0.0, 0.3})
            for (const ClusterOptions &options :
                 {ClusterOptions{.layers = 1}, ClusterOptions{.layers = 4}, ClusterOptions{.tolerance = 0.1},
                  ClusterOptions{.tolerance = 0.5, .layers = 2}}) {
                const Ldi ldi =
                    tidy(random_ldi({.most_samples = 20, .opaque_share = opaque, .volume_share = volumes}));
                const Image before = flatten(ldi), after = flatten(clustered(ldi, options).ldi);
                for (std::size_t i = 0; i < before.values.size(); ++i)
                    ASSERT_NEAR(before.values[i], after.values[i], 1e-6);
            }
}

TEST(Cluster, WeightsAddUp) {
    const Ldi ldi = tidy(random_ldi({.most_samples = 20}));
    const Ldi out = clustered(ldi, {.layers = 2}).ldi;
    for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel) {
        float before = 0, after = 0;
        for (const TestSample &s : samples_of(ldi, pixel)) before += s.weight;
        for (const TestSample &s : samples_of(out, pixel)) after += s.weight;
        EXPECT_EQ(before, after);
    }
}

TEST(Cluster, IntoKLayersTwiceIsOnce) {
    const Ldi once =
        clustered(tidy(random_ldi({.most_samples = 20, .opaque_share = 0.2})), {.layers = 3}).ldi;
    const Ldi twice = clustered(once, {.layers = 3}).ldi;
    EXPECT_EQ(once.begin, twice.begin);
    EXPECT_EQ(once.z, twice.z);
    EXPECT_EQ(once.weight, twice.weight);
    EXPECT_EQ(once.values, twice.values);
}

TEST(Cluster, TwoHundredSamplesBecomeFour) {
    TestPixel many;
    for (int i = 0; i < 200; ++i) many.push_back({.z = 1 + float(i) / 8, .colour = 0.01f, .alpha = 0.02f});
    const TestPixel p = clustered(many, {.layers = 4});
    EXPECT_EQ(p.size(), 4u);
    EXPECT_NEAR(flatten(ldi_of({p})).plane(0)[0], flatten(ldi_of({many})).plane(0)[0], 1e-6);
}

TEST(Cluster, TheSkyMergesWithWhatIsAsFarForTheLens) {
    const TestPixel far{{.z = 1e6f, .alpha = 0.5f}, {.z = inf, .alpha = 0.5f}};
    const TestPixel p = clustered(far, {.scale = 40, .tolerance = 0.25});
    ASSERT_EQ(p.size(), 1u);
    EXPECT_NEAR(p[0].z, 1.5e6, 1);
    const TestPixel near{{.z = 100, .alpha = 0.5f}, {.z = inf, .alpha = 0.5f}};
    EXPECT_EQ(clustered(near, {.scale = 40, .tolerance = 0.25}).size(), 2u);
    EXPECT_EQ(clustered(TestPixel{{.z = inf}}, {.scale = 40, .tolerance = 0.25})[0].z, inf);
}

TEST(Cluster, AlphaThatHalfCannotTellFromOneIsOpaqueNothingLessIs) {
    const auto first_colour = [](float alpha) {
        return clustered(TestPixel{{.z = 4, .colour = 0, .alpha = alpha}, {.z = 4.01f, .colour = 1e4f}},
                         {.layers = 1})[0]
            .colour;
    };
    EXPECT_EQ(first_colour(1), 0);
    EXPECT_EQ(first_colour(1 - 0x1p-13f), 0);
    EXPECT_FLOAT_EQ(first_colour(1 - 0x1p-11f),
                    1e4f * 0x1p-11f); // alpha of the half below 1: a bright lamp shines through
}

TEST(Cluster, IdsAreThoseOfTheFrontAndEmptyPixelsStayEmpty) {
    Ldi ldi = ldi_of({{{.z = 2, .alpha = 0.5f}, {.z = 3}}, {}});
    ldi.channels.push_back({"id", PixelType::uint32});
    ldi.values.push_back({11, 22});
    const Ldi out = clustered(ldi, {.layers = 1}).ldi;
    EXPECT_EQ(out.values[4], (std::vector<float>{11}));
    EXPECT_EQ(out.begin, (std::vector<std::uint64_t>{0, 1, 1}));
}

TEST(Cluster, ALensOfNoRadiusNeedsOneLayer) {
    const Ldi ldi = tidy(random_ldi({.most_samples = 5}));
    const Clustered out = clustered(ldi, {.scale = 0, .tolerance = 0.25});
    EXPECT_EQ(out.largest_error, 0);
    for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel)
        EXPECT_LE(samples_of(out.ldi, pixel).size(), 1u);
}

// One mirror at disparity 1, with images at these disparities.
Ldi mirror_of(std::initializer_list<double> images, double spacing, float alpha = 1) {
    return make_ldi(windows_of_size(1, 1), {{"R"}, {"A"}}, [&](int, int) {
        std::vector<Sample> samples;
        for (const double image : images) {
            const double depth = 1 - spacing * double(samples.size());
            samples.push_back({1 / depth, {float(samples.size()), alpha}});
            samples.back().image_z = 1 / image;
        }
        return samples;
    });
}

TEST(Cluster, UnlikeImagesStayApart) {
    const Ldi unlike = clustered(mirror_of({0.5, 0.8, 0.45}, 0.01), {.tolerance = 0.1}).ldi;
    ASSERT_EQ(unlike.samples(), 3u);
    EXPECT_FLOAT_EQ(unlike.image_z[1], 1 / 0.8f);
    const Clustered alike = clustered(mirror_of({0.5, 0.44}, 0.01, 0.5f), {.tolerance = 0.1});
    ASSERT_EQ(alike.ldi.samples(), 1u);
    EXPECT_NEAR(1 / alike.ldi.image_z[0], (0.5 * 0.5 + 0.25 * 0.44) / 0.75, 1e-6);
    EXPECT_NEAR(alike.largest_error, 0.06, 1e-6);
    const Clustered forced = clustered(mirror_of({-0.2, 0.4}, 0.01), {.layers = 1});
    ASSERT_EQ(forced.ldi.samples(), 1u);
    EXPECT_NEAR(forced.largest_error, 0.6, 1e-5);
}

} // namespace
} // namespace sparselens
