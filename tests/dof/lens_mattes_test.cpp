#include "deep/cluster.h"
#include "deep/flatten.h"
#include "deep/sanitize.h"
#include "dof/methods.h"
#include "support/lens_ldi.h"
#include "support/mattes.h"
#include "support/share_of_disc.h"
#include "view/view.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5}; // CoC up to 7.7 px behind focus

Image gather(const Ldi &ldi, const GatherMethod &method = gather_methods().front()) {
    Progress silent;
    return method.gather(ldi, lens, ldi.windows.data, {.layers = 8, .lens = {.quality = Quality::final}},
                         silent);
}

// A half plane with id 1 in front of focus, an edge at x = 40; a plane with id 2 in focus behind it.
Ldi half_plane() {
    return make_ldi(windows_of_size(80, 30), channels_with_matte(), [](int x, int) {
        const Sample back{lens.focus, {0, 0.5f, 0, 1, hashed(2), 1, 0, 0}};
        const Sample front{depth_of(lens, -8), {1, 0, 0, 1, hashed(1), 1, 0, 0}};
        return x < 40 ? std::vector{front, back} : std::vector{back};
    });
}

TEST(LensMattes, AMatteThroughTheLensIsTheDiscOfIt) {
    for (const GatherMethod &method : gather_methods()) {
        const Image picture = gather(half_plane(), method);
        for (int x = 10; x < 70; ++x) {
            const std::size_t pixel = picture.windows.index(Imath::V2i(x, 15));
            const double expected = share_of_disc(8, 40 - (x + 0.5));
            EXPECT_NEAR(coverage_in(picture, hashed(1), pixel), expected, 0.02) << method.name << " " << x;
            EXPECT_NEAR(coverage_in(picture, hashed(2), pixel), 1 - expected, 0.02)
                << method.name << " " << x;
        }
    }
}

// Each pair keeps its coverage over nothing and over other objects, and the larger comes first.
TEST(LensMattes, TheSumOverIdsIsAlphaAndRanksDescend) {
    Ldi ldi = make_ldi(windows_of_size(48, 40), channels_with_matte(3), [](int x, int y) {
        std::vector<Sample> samples;
        for (const double c : {-6.0, -2.0, 3.0})
            if (random_unit(x / 16, y / 16, std::uint32_t(c + 10)) < 0.6) {
                const float alpha = c == -2 ? 0.5f : 1.0f, part = 0.25f * alpha;
                const auto id = std::uint32_t(x / 16 + 20 + c);
                samples.push_back({depth_of(lens, c),
                                   {alpha, 0, 0, alpha, hashed(id), alpha - part, hashed(id + 1), part, 0, 0,
                                    0, 0, 0, 0, 0, 0}});
            }
        return samples;
    });
    const Image picture = gather(ldi);
    const std::vector<Matte> mattes = find_mattes(picture.channels);
    ASSERT_EQ(mattes.at(0).ranks.size(), 6u);
    int full = 0;
    for (std::size_t i = 0; i < picture.windows.pixels(); ++i) {
        double sum = 0, last = 2;
        for (const Matte::Rank &rank : mattes[0].ranks) {
            const double coverage = double(picture.plane(rank.coverage)[i]);
            EXPECT_LE(coverage, last);
            last = coverage;
            sum += coverage;
        }
        const double alpha = double(picture.plane(3)[i]);
        EXPECT_LE(sum, alpha + 1e-4);
        if (last > 0)
            ++full; // a seventh may have had no rank
        else
            EXPECT_NEAR(sum, alpha, 1e-4);
    }
    EXPECT_LT(full, 1000);
}

TEST(LensMattes, TheLightIsTheSameWithThem) {
    Ldi ldi = half_plane();
    const Image with = gather(ldi);
    ldi.channels.resize(4);
    ldi.values.resize(4);
    const Image without = gather(ldi);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_TRUE(std::ranges::equal(with.plane(k), without.plane(k)));
}

// 17 objects in five views give 17 in the LDI, in the clustered LDI and in the picture, bit for bit.
View view_of_17(const Imath::V2d &position) {
    View view;
    view.image = Image(windows_of_size(68, 24), channels_with_matte());
    view.position = position;
    view.z.resize(view.image.windows.pixels());
    for (std::size_t i = 0; i < view.z.size(); ++i) {
        const Imath::V2i p = view.image.windows.pixel(i);
        const auto id = std::uint32_t(p.x / 4);
        const bool edge = p.x % 4 == 3 && p.x < 67;
        view.z[i] = float(2 + id % 3);
        const std::vector<float> values{
            1, 1, 1, 1, hashed(id), edge ? 0.75f : 1.0f, edge ? hashed(id + 1) : 0, edge ? 0.25f : 0.0f};
        for (std::size_t k = 0; k < values.size(); ++k) view.image.plane(k)[i] = values[k];
    }
    return view;
}

TEST(LensMattes, SeventeenIdsStaySeventeen) {
    std::vector<View> views;
    for (const Imath::V2d &position : {Imath::V2d(0, 0), Imath::V2d(0.06, 0), Imath::V2d(0, 0.06),
                                       Imath::V2d(-0.06, 0), Imath::V2d(0, -0.06)})
        views.push_back(view_of_17(position));
    std::set<std::uint32_t> expected;
    for (std::uint32_t id = 0; id < 17; ++id) expected.insert(std::bit_cast<std::uint32_t>(hashed(id)));
    for (View &view : views) {
        const auto before = view.image.values;
        EXPECT_FALSE(sanitize(view).any()); // hashes above 1e34 are valid
        EXPECT_TRUE(std::ranges::equal(before, view.image.values, {}, std::bit_cast<std::uint32_t, float>,
                                       std::bit_cast<std::uint32_t, float>));
        EXPECT_EQ(ids_in(view.image), expected);
    }
    Progress silent;
    const Ldi warped = warp(views, {.focal_px = 100, .radius = 0.06}, silent);
    EXPECT_EQ(ids_in(warped), expected);
    const Ldi clustered = cluster(warped, {.scale = 6, .tolerance = 2, .layers = 1}, silent).ldi;
    EXPECT_LT(clustered.samples(), warped.samples());
    EXPECT_EQ(ids_in(clustered), expected);
    EXPECT_EQ(ids_in(flatten(clustered)), expected);
    EXPECT_EQ(ids_in(gather(clustered)), expected);
}

// A merged sample has the pairs of all its samples, weighted by their visible shares.
TEST(LensMattes, MergedSamplesUniteTheirPairs) {
    const Ldi ldi = make_ldi(windows_of_size(1, 1), channels_with_matte(), [](int, int) {
        return std::vector<Sample>{{4, {0, 0, 0, 0.5f, hashed(1), 0.5f, 0, 0}},
                                   {4.0001, {0, 0, 0, 1, hashed(2), 0.6f, hashed(1), 0.4f}}};
    });
    Progress silent;
    const Ldi merged = cluster(ldi, {.scale = 10, .tolerance = 1, .layers = 1}, silent).ldi;
    ASSERT_EQ(merged.samples(), 1u);
    const auto of = [&](float id) {
        return coverage_of(find_mattes(merged.channels), id,
                           [&](std::size_t k) { return merged.values[k][0]; });
    };
    EXPECT_NEAR(of(hashed(1)), 0.7, 1e-6);
    EXPECT_NEAR(of(hashed(2)), 0.3, 1e-6);
    EXPECT_EQ(merged.values[4][0], hashed(1)); // the first rank
}

// Normals are a weighted mean: a bright one is not a lamp, and nothing near focus is sharpened.
TEST(LensMattes, DataIsAMean) {
    std::vector<Channel> channels = rgba_channels();
    channels.push_back({"P.X", PixelType::float32});
    channels.push_back({"P.R", PixelType::float32});
    const auto make = [&](double c) {
        return make_ldi(windows_of_size(40, 40), channels, [&](int x, int y) {
            const float value = x == 20 && y == 20 ? 1000 : float(x % 8 == 0);
            return std::vector<Sample>{{depth_of(lens, c), {0.5f, 0.5f, 0.5f, 1, value, value}}};
        });
    };
    for (const double c : {0.7, 5.0}) {
        Ldi as_data = make(c), as_light = as_data;
        find_kinds(as_data.channels);
        as_data.values[0][20 * 40 + 20] = as_light.values[0][20 * 40 + 20] = 1000; // a lamp of the picture
        if (c < 1)
            for (auto *values : {&as_data.values, &as_light.values})
                for (std::size_t i = 0; i < 1600; ++i)
                    (*values)[0][i] = float(i % 8 == 0); // detail that sharpening would change
        const Image data = gather(as_data), light = gather(as_light);
        EXPECT_TRUE(std::ranges::equal(data.plane(0), light.plane(0))) << c;
        EXPECT_FALSE(std::ranges::equal(data.plane(4), light.plane(4))) << c;
        Ldi alone = as_data;
        for (std::size_t k = 0; k < 3; ++k)
            std::ranges::fill(alone.values[k], 0.5f); // nothing bright or sharp
        EXPECT_TRUE(std::ranges::equal(data.plane(4), gather(alone).plane(4))) << c;
    }
}

} // namespace
} // namespace sparselens
