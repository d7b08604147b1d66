#include "deep/channel_alpha.h"
#include "deep/cluster.h"
#include "deep/flatten.h"
#include "deep/merge.h"
#include "deep/proxy.h"
#include "deep/tidy.h"
#include "dof/methods.h"
#include "support/ldi_samples.h"

#include <gtest/gtest.h>

#include <array>

namespace sparselens {
namespace {

std::vector<Channel> named(const std::vector<std::string> &names) {
    std::vector<Channel> channels;
    for (const std::string &name : names) channels.push_back({name});
    return channels;
}

// A random LDI with its own coverage for each colour, and a further layer.
Ldi coloured(const RandomLdi &how) {
    Ldi ldi = random_ldi(how);
    ldi.channels = named({"R", "G", "B", "A", "AB", "AG", "AR", "diffuse.G", "depth.x"});
    ldi.values.resize(ldi.channels.size(), std::vector<float>(ldi.samples()));
    for (std::size_t i = 0; i < ldi.samples(); ++i) {
        const float a = ldi.values[3][i] *= 0.9f; // clusters would average opaque samples
        ldi.values[4][i] = a * a;
        ldi.values[5][i] = 1 - (1 - a) * (1 - a);
        ldi.values[6][i] = 0.4f * float(i % 3);
        ldi.values[7][i] = 0.5f * ldi.values[1][i];
        ldi.values[8][i] = float(i % 7);
    }
    return ldi;
}

// The same LDI with `coverage` in place of A: an ordinary LDI expresses by A what AR means for R.
Ldi covered_by(Ldi ldi, const std::string &coverage) {
    ldi.values[ldi.alpha()] = ldi.values[find_channel(ldi.channels, coverage)];
    for (const char *name : {"AR", "AG", "AB"})
        ldi.channels[find_channel(ldi.channels, name)].name = std::string("x.") + name;
    return ldi;
}

const std::vector<std::pair<std::string, std::string>> covers{
    {"R", "AR"}, {"G", "AG"}, {"B", "AB"}, {"diffuse.G", "AG"}, {"A", "A"}, {"depth.x", "A"}};

TEST(ColouredAlpha, EveryChannelHasItsCoverage) {
    const auto channels = named(
        {"R", "A", "AR", "AG", "AB", "fog.R", "fog.AR", "fog.AG", "fog.AB", "key.R", "key.AR", "N.x", "Z"});
    const auto coverage = [&](const char *name) {
        return channels[coverage_of(channels, find_channel(channels, name))].name;
    };
    EXPECT_EQ(coverage("R"), "AR");
    EXPECT_EQ(coverage("AR"), "AR");
    EXPECT_EQ(coverage("fog.R"), "fog.AR");
    EXPECT_EQ(coverage("fog.AG"), "fog.AG");
    EXPECT_EQ(coverage("key.R"), "AR"); // the layer lacks one of its own three
    EXPECT_EQ(coverage("A"), "A");
    EXPECT_EQ(coverage("N.x"), "A");
    EXPECT_EQ(coverage_of(named({"R", "AR"}), 0), npos);
    EXPECT_EQ(coverage_of(named({"R", "A", "AR", "AG"}), 0), 1u);
}

TEST(ColouredAlpha, AIsTheMeanWhereItIsMissing) {
    Ldi ldi = ldi_of({{{.z = 1}, {.z = 2}}});
    ldi.channels = named({"R", "AB", "AG", "AR"});
    ldi.values = {{1, 1}, {0.25f, 0.3f}, {0.5f, 0.3f}, {0.75f, 0.3f}};
    add_mean_coverage(ldi);
    EXPECT_EQ(ldi.channels, named({"R", "A", "AB", "AG", "AR"}));
    EXPECT_EQ(ldi.values[1], (std::vector<float>{0.5f, 0.3f}));
    const Ldi once = ldi;
    add_mean_coverage(ldi);
    EXPECT_EQ(ldi.channels, once.channels);

    Image image(windows_of_size(2, 1), named({"G", "AB", "AG", "AR"}));
    image.values = {7, 8, 0, 1, 0.5f, 1, 1, 1};
    add_mean_coverage(image);
    EXPECT_EQ(image.channels, named({"G", "A", "AB", "AG", "AR"}));
    EXPECT_EQ(image.values, (LargeArray<float>{7, 8, 0.5f, 1, 0, 1, 0.5f, 1, 1, 1}));
}

// Red glass before a white wall: each colour of the background passes by its own share.
TEST(ColouredAlpha, FlattenAttenuatesEachColourByItsOwn) {
    Ldi ldi = ldi_of({{{.z = 1}, {.z = 2}}});
    ldi.channels = named({"R", "G", "B", "A", "AB", "AG", "AR"});
    ldi.values = {{0.125f, 1}, {0, 1}, {0, 1}, {0.5f, 1}, {1, 1}, {0.5f, 1}, {0, 1}};
    const Image picture = flatten(ldi);
    EXPECT_EQ(picture.values, (LargeArray<float>{1.125f, 0.5f, 0, 1, 1, 1, 1}));
}

TEST(ColouredAlpha, EqualToAItIsNone) {
    Ldi ldi = coloured({});
    for (const char *name : {"AR", "AG", "AB"})
        ldi.values[find_channel(ldi.channels, name)] = ldi.values[ldi.alpha()];
    EXPECT_EQ(by_coverage(ldi).size(), 1u);
    EXPECT_EQ(by_coverage(coloured({})).size(), 4u);
    EXPECT_EQ(by_coverage(random_ldi({})).size(), 1u);
}

// expect(channel, coloured LDI, ordinary LDI): compares each channel with an LDI in which its coverage is A.
template <typename Made>
void expect_as_by_alpha(const Ldi &ldi, const Made &make) {
    const auto whole = make(ldi);
    for (const auto &[name, coverage] : covers) {
        const auto one = make(covered_by(ldi, coverage));
        const std::size_t k = find_channel(ldi.channels, name);
        ASSERT_EQ(whole[k].size(), one[k].size());
        for (std::size_t i = 0; i < one[k].size(); ++i) ASSERT_FLOAT_EQ(whole[k][i], one[k][i]) << name;
        if (coverage == "A") continue;
        const std::size_t c = find_channel(ldi.channels, coverage), alpha = ldi.alpha();
        for (std::size_t i = 0; i < one[alpha].size(); ++i)
            ASSERT_FLOAT_EQ(whole[c][i], one[alpha][i]) << coverage;
    }
}

std::vector<std::vector<float>> planes_of(const Image &image) {
    std::vector<std::vector<float>> planes;
    for (std::size_t k = 0; k < image.channels.size(); ++k)
        planes.emplace_back(image.plane(k).begin(), image.plane(k).end());
    return planes;
}

TEST(ColouredAlpha, TidyMergesAndSplitsByIt) {
    const Ldi ldi = coloured({.volume_share = 0.5, .shuffled = true, .depths = 5});
    expect_as_by_alpha(ldi, [](const Ldi &l) { return tidy(l).values; });
    expect_as_by_alpha(ldi, [](const Ldi &l) { return planes_of(flatten(tidy(l))); });
}

TEST(ColouredAlpha, ClustersFlattenAsTheyDid) {
    const Ldi ldi = tidy(coloured({.width = 32}));
    Progress silent;
    const auto clustered = [&](const Ldi &l) {
        return cluster(l, {.scale = 100, .tolerance = 5, .layers = 2}, silent).ldi;
    };
    expect_as_by_alpha(ldi, [&](const Ldi &l) { return clustered(l).values; });
    const Image before = flatten(ldi), after = flatten(clustered(ldi));
    ASSERT_LT(clustered(ldi).samples(), ldi.samples());
    for (const char *name : {"R", "G", "B"}) {
        const std::size_t k = find_channel(ldi.channels, name);
        for (std::size_t i = 0; i < before.windows.pixels(); ++i)
            ASSERT_NEAR(before.plane(k)[i], after.plane(k)[i], 1e-5) << name;
    }
}

TEST(ColouredAlpha, ProxiesAndHoldoutsKnowIt) {
    const Ldi ldi = tidy(coloured({}));
    expect_as_by_alpha(ldi, [](const Ldi &l) { return planes_of(flatten(proxy(l, 2))); });
    const Holdout holdout(random_ldi({.seed = 2}));
    expect_as_by_alpha(ldi, [&](const Ldi &l) { return planes_of(flatten_held_out(l, holdout)); });
}

// Tinted glass before a white wall, both without an edge: blur changes nothing.
TEST(ColouredAlpha, EveryMethodSeesThroughByColour) {
    constexpr int size = 24;
    Ldi ldi = ldi_of(std::vector<TestPixel>(size * size, {{.z = 2}, {.z = 8}}));
    ldi.windows = windows_of_size(size, size);
    ldi.channels = named({"R", "G", "B", "A", "AB", "AG", "AR"});
    const std::array<float, 7> glass{0.125f, 0.25f, 0, 0.5f, 0.875f, 0.5f, 0.125f};
    ldi.values.assign(7, std::vector<float>(ldi.samples(), 1));
    for (std::size_t k = 0; k < glass.size(); ++k)
        for (std::size_t i = 0; i < ldi.samples(); i += 2) ldi.values[k][i] = glass[k];
    const ThinLens lens{.radius = 0.2, .focal_px = 100, .focus = 4};
    for (const GatherMethod &method : gather_methods()) {
        Progress silent;
        const Image picture = method.gather(ldi, lens, ldi.windows.data, {}, silent);
        ASSERT_EQ(picture.channels, ldi.channels);
        const std::array<float, 7> expected{1, 0.75f, 0.125f, 1, 1, 1, 1};
        for (std::size_t k = 0; k < expected.size(); ++k)
            EXPECT_NEAR(picture.at(k, size / 2, size / 2), expected[k], 2e-3)
                << method.name << " " << ldi.channels[k].name;
    }
}

} // namespace
} // namespace sparselens
