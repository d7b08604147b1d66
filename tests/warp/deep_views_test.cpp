// Deep views in the warp: alone, beside flat ones, at the centre and on the rim; results in closed form.
#include "deep/tidy.h"
#include "deep/view_samples.h"
#include "support/ldi_samples.h"
#include "warp/warp_fixture.h"

#include <gtest/gtest.h>

#include <array>

namespace sparselens {
namespace {

using namespace warping;

const std::vector<Imath::V2d> places{{0, 0}, {radius, 0}, {0, radius}, {-radius, 0}, {0, -radius}};

PackedView deep_view(Ldi ldi, const Imath::V2d &position = {0, 0}) {
    PackedView view("deep", std::move(ldi));
    view.position = position;
    return view;
}

Ldi warped_of(std::vector<PackedView> views, const WarpOptions &options = averaging) {
    Progress silent;
    return warp(std::move(views), options, silent);
}

Ldi deep_of(const View &view) {
    const std::size_t alpha = find_channel(view.image.channels, "A");
    return make_ldi(view.image.windows, view.image.channels, [&](int x, int y) {
        const std::size_t p = view.image.windows.index(Imath::V2i(x, y));
        if (!(view.z[p] > 0) || view.image.plane(alpha)[p] == 0) return std::vector<Sample>();
        Sample sample{.z = double(view.z[p]), .values = {}};
        for (std::size_t k = 0; k < view.image.channels.size(); ++k)
            sample.values.push_back(view.image.plane(k)[p]);
        return std::vector<Sample>{sample};
    });
}

Ldi constant(const Windows &windows, const std::vector<Sample> &samples) {
    return make_ldi(windows, rgba_channels(), [&](int, int) { return samples; });
}

void expect_own_samples(const Ldi &made, const Ldi &given) {
    EXPECT_EQ(made.windows, given.windows);
    EXPECT_EQ(made.begin, given.begin);
    EXPECT_EQ(made.z, given.z);
    EXPECT_EQ(made.z_back, given.z_back);
    EXPECT_EQ(made.values, given.values);
    EXPECT_EQ(made.dx, std::vector<float>(given.samples(), 0));
}

TEST(DeepViews, OneViewGivesItsOwnSamples) {
    for (const double volumes : {0.0, 0.3}) {
        const Ldi given = tidy(random_ldi({.seed = 3, .opaque_share = 0.2, .volume_share = volumes}));
        for (const WarpOptions &options : {averaging, keeping}) {
            std::vector<PackedView> views;
            views.push_back(deep_view(given));
            EXPECT_TRUE(views[0].samples.deep());
            expect_own_samples(warped_of(std::move(views), options), given);
        }
    }
}

TEST(DeepViews, OfOneSampleAPixelAreFlatViews) {
    WarpOptions splitting = averaging;
    splitting.split_silhouettes = true;
    const Windows windows = windows_of_size(48, 16);
    for (std::vector<View> flat : {five_views(fence(), windows, radius), random_views(windows, 5)}) {
        std::vector<PackedView> deep;
        for (const View &view : flat) {
            PackedView of_view("view", deep_of(view));
            of_view.position = view.position;
            of_view.framing = view.framing;
            deep.push_back(std::move(of_view));
        }
        EXPECT_FALSE(deep[0].samples.deep());
        expect_same_bits(warped_of(std::move(deep), splitting), warped(flat, splitting));
    }
}

// Two cards of half coverage before a wall. Their disparities are 3, 2 and 1 pixels, so that samples fall on
// pixel centres.
std::vector<Sample> two_cards(float second = 0.5f, float green = 1) {
    return {{.z = 2, .values = {0.5f, 0, 0, 0.5f}},
            {.z = 3, .values = {0, second * green, 0, second}},
            {.z = 6, .values = {0, 0, 1, 1}}};
}

TEST(DeepViews, TwoCardsAreSeenThroughBesideFlatViews) {
    const Windows windows = windows_of_size(24, 24);
    std::vector<PackedView> views;
    views.push_back(deep_view(constant(windows, two_cards())));
    for (std::size_t v = 1; v < places.size(); ++v)
        views.emplace_back(make_view(windows, places[v], [](int, int) {
            return ViewPixel{.z = 2, .r = 0.5f, .g = 0.25f, .b = 0.25f, .a = 1};
        }));
    const Ldi ldi = warped_of(std::move(views));
    const Ldi expected = constant(windows, two_cards());
    for_each_pixel(ldi.windows.data, [&](int x, int y) { // beyond the frame they continue
        const SampleRange samples = ldi.pixel(ldi.windows.index(Imath::V2i(x, y)));
        ASSERT_EQ(samples.size(), 3u) << x << "," << y;
        for (std::size_t n = 0; n < 3; ++n) {
            EXPECT_EQ(ldi.z[samples.from + n], expected.z[n]);
            for (std::size_t k = 0; k < 4; ++k)
                EXPECT_EQ(ldi.values[k][samples.from + n], expected.values[k][n]);
        }
    });
}

// The light of a card in all views, relative to its coverage and to the share that the card before it lets through:
// half everywhere.
TEST(DeepViews, TheCentreKeepsItsCoverageAndColoursAreMeans) {
    const Windows windows = windows_of_size(24, 24);
    const std::array<float, 5> covers{0.5f, 0.25f, 0.75f, 0.5f, 1}, green{1, 0, 0.5f, 0.25f, 1};
    std::vector<PackedView> views;
    double light = 0, covered = 0;
    for (std::size_t v = 0; v < places.size(); ++v) {
        std::vector<Sample> samples = two_cards(covers[v], green[v]);
        views.push_back(deep_view(constant(windows, samples), places[v]));
        light += double(covers[v] * green[v]);
        covered += double(covers[v]);
    }
    const Ldi ldi = warped_of(std::move(views));
    const SampleRange samples = ldi.pixel(ldi.windows.index(Imath::V2i(12, 12)));
    ASSERT_EQ(samples.size(), 3u);
    const std::uint64_t card = samples.from + 1;
    EXPECT_EQ(ldi.z[card], 3);
    EXPECT_EQ(ldi.values[3][card], 0.5f);
    EXPECT_NEAR(ldi.values[1][card], 0.5 * light / covered, 1e-6);
    EXPECT_NEAR(ldi.weight[card], 5 * 0.5, 1e-6);
}

// Coverage for red in AR, for green in AG; ids come from the centre view.
TEST(DeepViews, CoverageByColourAndIdsStay) {
    const std::vector<Channel> channels{{"R"},  {"G"},  {"B"},  {"A"},
                                        {"AR"}, {"AG"}, {"AB"}, {"id", PixelType::uint32}};
    const auto view_of = [&](float red, float green, float id, const Imath::V2d &position) {
        const std::vector<Sample> samples{
            {.z = 2, .values = {red * 0.25f, green * 0.75f, 0, 0.5f, 0.25f, 0.75f, 0.5f, id}},
            {.z = 6, .values = {0, 0, 1, 1, 1, 1, 1, 9}}};
        return deep_view(make_ldi(windows_of_size(24, 24), channels, [&](int, int) { return samples; }),
                         position);
    };
    std::vector<PackedView> views;
    views.push_back(view_of(1, 0, 5, places[0]));
    views.push_back(view_of(0, 0.5f, 6, places[1]));
    const Ldi ldi = warped_of(std::move(views));
    const SampleRange samples = ldi.pixel(ldi.windows.index(Imath::V2i(10, 12)));
    ASSERT_EQ(samples.size(), 2u);
    const std::vector<float> expected{0.125f, 0.1875f, 0, 0.5f, 0.25f, 0.75f, 0.5f, 5};
    for (std::size_t k = 0; k < channels.size(); ++k)
        EXPECT_NEAR(ldi.values[k][samples.from], expected[k], 1e-6) << channels[k].name;
}

// Volumes keep both depths, even those that only a rim view sees.
TEST(DeepViews, VolumesStayVolumes) {
    const Windows windows = windows_of_size(40, 3);
    const std::vector<Sample> volume{{.z = 6, .values = {0.5f, 0, 0, 0.5f}, .z_back = 6.1f}};
    const auto board_from = [&](int first) {
        return make_ldi(windows, rgba_channels(), [=](int x, int) {
            return x >= first && x < first + 10 ? std::vector<Sample>{{.z = 2, .values = {0, 0, 1, 1}}}
                                                : volume;
        });
    };
    std::vector<PackedView> views;
    views.push_back(deep_view(board_from(10)));
    views.push_back(deep_view(board_from(7), {radius, 0}));
    const Ldi ldi = warped_of(std::move(views));
    for (const int x : {5, 19}) {
        const TestSample last = pixel_at(ldi, x, 1).back();
        EXPECT_FLOAT_EQ(last.z, 6) << x;
        EXPECT_FLOAT_EQ(last.z_back, 6.1f) << x;
        EXPECT_FLOAT_EQ(last.alpha, 0.5f) << x;
    }
}

// Behind a board, past which the centre view does not look, a rim view sees two veils of one surface and nothing behind
// them: one sample, composited from both.
TEST(DeepViews, VeilsThatOnlyTheRimSeesAreComposited) {
    const Windows windows = windows_of_size(40, 3);
    const std::vector<Sample> veils{{.z = 6, .values = {0.5f, 0, 0, 0.5f}},
                                    {.z = 6.1, .values = {0, 0.5f, 0, 0.5f}}};
    const auto board_from = [&](int first) {
        return make_ldi(windows, rgba_channels(), [=](int x, int) {
            return x >= first && x < first + 10 ? std::vector<Sample>{{.z = 2, .values = {0, 0, 1, 1}}}
                                                : veils;
        });
    };
    std::vector<PackedView> views;
    views.push_back(deep_view(board_from(10)));
    views.push_back(deep_view(board_from(7), {radius, 0}));
    const Ldi ldi = warped_of(std::move(views));
    const TestPixel seen = pixel_at(ldi, 5, 1), hidden = pixel_at(ldi, 19, 1);
    EXPECT_EQ(seen.size(), 2u) << "the centre's samples stay apart";
    ASSERT_EQ(hidden.size(), 2u);
    EXPECT_EQ(hidden[0].z, 2);
    EXPECT_NEAR(hidden[1].alpha, 0.75, 1e-6);
    EXPECT_NEAR(hidden[1].colour, 0.5, 1e-6);
    EXPECT_NEAR(ldi.values[1][ldi.pixel(ldi.windows.index(Imath::V2i(19, 1))).from + 1], 0.25, 1e-6);
    EXPECT_EQ(pixel_at(ldi, 15, 1).size(), 1u) << "no view looks there";
}

// Samples of a rim view in front of everything that the deep centre sees through, or between, are there only by
// rounding.
TEST(DeepViews, TheCentreSeesAllThatStandsBeforeItsWall) {
    const Windows windows = windows_of_size(24, 24);
    std::vector<Sample> with_another = two_cards();
    with_another.insert(with_another.begin() + 2, {.z = 4, .values = {0.5f, 0.5f, 0.5f, 0.5f}});
    std::vector<PackedView> views;
    views.push_back(deep_view(constant(windows, two_cards())));
    views.push_back(deep_view(constant(windows, with_another), {radius, 0}));
    EXPECT_EQ(pixel_at(warped_of(std::move(views)), 12, 12).size(), 3u);
}

TEST(DeepViews, WhatLiesBehindTheCentreIsLeftOut) {
    PackedView view = deep_view(constant(windows_of_size(3, 1), two_cards()));
    view.samples.move_back(-2.5);
    EXPECT_TRUE(view.samples.deep());
    EXPECT_EQ(view.samples.as_ldi().z, (std::vector<float>{0.5f, 3.5f, 0.5f, 3.5f, 0.5f, 3.5f}));
    view.samples.move_back(-1);
    EXPECT_EQ(view.samples.as_ldi().values[2], (std::vector<float>{1, 1, 1}));
}

TEST(DeepViews, AreOrderedByTheirParts) {
    const PackedView one = deep_view(constant(windows_of_size(3, 1), two_cards())),
                     same = deep_view(constant(windows_of_size(3, 1), two_cards())),
                     greener = deep_view(constant(windows_of_size(3, 1), two_cards(0.5f, 2)));
    EXPECT_TRUE((one.samples <=> same.samples) == 0);
    EXPECT_TRUE(one.samples < greener.samples);
}

} // namespace
} // namespace sparselens
