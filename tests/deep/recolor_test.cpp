// Deep samples with the colours of a flat picture: closed forms, and a picture composited again with the slow
// composite.
#include "base/light.h"
#include "deep/flatten.h"
#include "deep/recolor.h"
#include "deep/tidy.h"
#include "support/composite.h"
#include "support/ldi_samples.h"
#include "support/order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// One pixel of R, G, B (colour, colour / 2, colour / 4) and A.
Image flat_pixel(float colour, float alpha) {
    Image image(windows_of_size(1, 1), rgba_channels());
    for (std::size_t k = 0; k < 3; ++k) image.plane(k)[0] = std::ldexp(colour, -int(k));
    image.plane(3)[0] = alpha;
    return image;
}

Recolored recolored(const TestPixel &pixel, float colour, float alpha) {
    return recolor(ldi_of({pixel}), flat_pixel(colour, alpha));
}

float value(const Ldi &ldi, const char *channel, std::size_t i) {
    return ldi.values[find_channel(ldi.channels, channel)][i];
}

TEST(Recolor, ASampleShowsItsShareOfWhatAllShow) {
    // D = 1/2 + 1/2 * 1/2 = 3/4; unit colour 0.6 / 0.75 = 0.8.
    const Recolored made =
        recolored({{.z = 1, .colour = 9, .alpha = 0.5f}, {.z = 2, .alpha = 0.5f}}, 0.6f, 0.75f);
    ASSERT_EQ(made.ldi.samples(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_FLOAT_EQ(value(made.ldi, "R", i), 0.4f);
        EXPECT_FLOAT_EQ(value(made.ldi, "G", i), 0.2f);
        EXPECT_EQ(value(made.ldi, "A", i), 0.5f);
    }
    EXPECT_EQ(made.ldi.z, (std::vector<float>{1, 2}));
    EXPECT_EQ(made.differ, 0U);
}

TEST(Recolor, WhatTheFlatPictureCoversAloneLiesAtInfinity) {
    const Recolored made = recolored({{.z = 1, .alpha = 0.25f}}, 0.8f, 1);
    ASSERT_EQ(made.ldi.samples(), 2U);
    EXPECT_EQ(made.ldi.z[1], infinity);
    EXPECT_FLOAT_EQ(value(made.ldi, "R", 0), 0.2f);
    EXPECT_FLOAT_EQ(value(made.ldi, "R", 1), 0.8f);
    EXPECT_EQ(value(made.ldi, "A", 1), 1);
    EXPECT_EQ(made.differ, 1U);
    EXPECT_EQ(made.infinite, 1U);
}

TEST(Recolor, WhatTheFlatPictureCoversLessKeepsItsCoverageAndLight) {
    const Recolored made = recolored({{.z = 1, .alpha = 1}}, 0.3f, 0.5f);
    ASSERT_EQ(made.ldi.samples(), 1U);
    EXPECT_FLOAT_EQ(value(made.ldi, "R", 0), 0.3f);
    EXPECT_EQ(value(made.ldi, "A", 0), 1);
    EXPECT_EQ(made.differ, 1U);
}

TEST(Recolor, CoverageThatDiffersByRoundingAgrees) {
    const Recolored made = recolored({{.z = 1, .alpha = 0.5f}}, 0.6f, 0.51f);
    EXPECT_EQ(made.ldi.samples(), 1U);
    EXPECT_EQ(made.differ, 0U);
    EXPECT_FLOAT_EQ(value(made.ldi, "R", 0), 0.6f);
}

TEST(Recolor, LightWithoutSamplesIsAtInfinity) {
    const Recolored sky = recolored({}, 0.5f, 1), glow = recolored({}, 0.5f, 0),
                    nothing = recolored({}, 0, 0);
    EXPECT_EQ(nothing.ldi.samples(), 0U);
    for (const Recolored *made : {&sky, &glow}) {
        ASSERT_EQ(made->ldi.samples(), 1U);
        EXPECT_EQ(made->ldi.z[0], infinity);
        EXPECT_EQ(value(made->ldi, "R", 0), 0.5f);
    }
    EXPECT_EQ(value(sky.ldi, "A", 0), 1);
    EXPECT_EQ(value(glow.ldi, "A", 0), 0);
    EXPECT_EQ(sky.differ, 1U);
    EXPECT_EQ(glow.differ, 0U); // coverages agree: none differ
}

TEST(Recolor, LightOfNoCoverageGoesToWhatCovers) {
    const Recolored made = recolored({{.z = 1, .alpha = 0.5f}}, 0.5f, 0);
    ASSERT_EQ(made.ldi.samples(), 1U);
    EXPECT_FLOAT_EQ(value(made.ldi, "R", 0), 0.5f);
}

TEST(Recolor, AnOldLightAtInfinityIsReplaced) {
    const Recolored made = recolored({{.z = infinity, .colour = 7, .alpha = 0}}, 0.5f, 1);
    ASSERT_EQ(made.ldi.samples(), 1U);
    EXPECT_EQ(value(made.ldi, "R", 0), 0.5f);
    EXPECT_EQ(value(made.ldi, "A", 0), 1);
}

TEST(Recolor, WithoutCoverageInTheFlatPictureThatOfTheSamplesCounts) {
    Image flat(windows_of_size(1, 1), {{"R"}, {"G"}, {"B"}});
    flat.plane(0)[0] = 0.5f;
    const Recolored made = recolor(ldi_of({{{.z = 1, .alpha = 0.25f}}}), flat);
    ASSERT_EQ(made.ldi.samples(), 1U);
    EXPECT_FLOAT_EQ(value(made.ldi, "R", 0), 0.5f);
    EXPECT_EQ(made.differ, 0U);
    EXPECT_EQ(recolor(ldi_of({{}}), flat).ldi.samples(), 1U);
}

TEST(Recolor, WithoutCoverageInTheDeepPictureSamplesAreOpaque) {
    Ldi ldi = ldi_of({{{.z = 1}, {.z = 2}}});
    ldi.channels = {{"id", PixelType::uint32}};
    ldi.values = {{5, 6}};
    const Recolored made = recolor(ldi, flat_pixel(0.5f, 1));
    EXPECT_EQ(value(made.ldi, "A", 0), 1);
    EXPECT_EQ(value(made.ldi, "R", 0), 0.5f);
    EXPECT_EQ(value(made.ldi, "R", 1), 0.5f); // the value of the sample that hides it
    EXPECT_EQ(value(made.ldi, "id", 1), 6);
}

TEST(Recolor, IdsAndDataStayAndOtherLightGoes) {
    Ldi ldi = ldi_of({{{.z = 1, .alpha = 0.5f}}});
    for (const auto &[name, kind] : {std::pair{"N.X", ChannelKind::data},
                                     {"glow.R", ChannelKind::light},
                                     {"diffuse.R", ChannelKind::light}}) {
        ldi.channels.push_back({name, PixelType::half, kind});
        ldi.values.push_back({0.125f});
    }
    Image flat(windows_of_size(1, 1), rgba_channels());
    flat.channels.insert(flat.channels.end(), {{"diffuse.R"},
                                               {"N.X", PixelType::half, ChannelKind::data},
                                               {"Z", PixelType::half, ChannelKind::data}});
    flat.values.resize(7);
    flat.plane(3)[0] = 0.5f;
    flat.plane(4)[0] = 0.75f;
    flat.plane(5)[0] = 0.25f;
    const Ldi made = recolor(ldi, flat).ldi;
    EXPECT_EQ(value(made, "N.X", 0), 0.125f);
    EXPECT_FLOAT_EQ(value(made, "diffuse.R", 0), 0.75f);
    EXPECT_EQ(find_channel(made.channels, "glow.R"), npos);
    EXPECT_EQ(find_channel(made.channels, "Z"), npos);
}

TEST(Recolor, EachColourIsSharedByItsOwnCoverage) {
    Ldi ldi = ldi_of({{{.z = 1, .alpha = 0.5f}, {.z = 2, .alpha = 0.5f}}});
    const float coverage[3][2] = {{0.5f, 0.5f}, {0.25f, 1}, {0, 0}};
    for (std::size_t c = 0; c < 3; ++c) {
        ldi.channels.push_back({std::string("A") + rgb_names[c]});
        ldi.values.push_back({coverage[c][0], coverage[c][1]});
    }
    const Recolored made = recolor(ldi, flat_pixel(0.6f, 0.75f));
    EXPECT_FLOAT_EQ(value(made.ldi, "G", 0), 0.3f * 0.25f);
    EXPECT_FLOAT_EQ(value(made.ldi, "G", 1), 0.3f);
    EXPECT_FLOAT_EQ(value(made.ldi, "B", 0), 0.075f); // by A: half of what both show
    const Image seen = flatten(made.ldi);
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_FLOAT_EQ(seen.plane(find_channel(seen.channels, rgb_names[k]))[0], std::ldexp(0.6f, -int(k)));
}

TEST(Recolor, HasThePixelsOfTheFlatPicture) {
    Ldi ldi = ldi_of({{{.z = 1}}, {{.z = 2}}, {}});
    Image flat(Windows{ldi.windows.display, {{1, 0}, {3, 0}}}, rgba_channels());
    flat.plane(0)[0] = flat.plane(3)[0] = flat.plane(0)[2] = 1;
    const Recolored made = recolor(ldi, flat);
    EXPECT_EQ(made.beyond, 1U);
    EXPECT_EQ(made.ldi.windows, flat.windows);
    EXPECT_EQ(made.ldi.z, (std::vector<float>{2, infinity}));
    EXPECT_EQ(made.ldi.begin, (std::vector<std::uint64_t>{0, 1, 1, 2}));
}

TEST(Recolor, FlattensToTheFlatPicture) {
    for (const double volumes : {0.0, 0.5}) {
        const Ldi ldi = tidy(random_ldi(
            {.width = 32, .height = 32, .most_samples = 20, .volume_share = volumes, .shuffled = true}));
        Image flat = flatten(ldi);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t p = 0; p < flat.windows.pixels(); ++p)
                flat.plane(k)[p] = flat.plane(3)[p] * float(random_unit(int(p), int(k), 3));
        for (std::size_t p = 0; p < flat.windows.pixels(); p += 3) // another coverage
            flat.plane(3)[p] = float(random_unit(int(p), 0, 4));
        const Recolored made = recolor(ldi, flat);
        EXPECT_TRUE(order_of(made.ldi).sorted && order_of(made.ldi).apart);
        const std::size_t red = find_channel(made.ldi.channels, "R"), alpha = made.ldi.alpha();
        for (std::size_t p = 0; p < flat.windows.pixels(); ++p) {
            TestPixel pixel;
            for (const std::uint64_t i : made.ldi.pixel(p))
                pixel.push_back({.z = made.ldi.z[i],
                                 .colour = made.ldi.values[red][i],
                                 .alpha = made.ldi.values[alpha][i]});
            const Composite seen = composite_in_order(pixel);
            ASSERT_NEAR(double(seen.colour), double(flat.plane(0)[p]), 1e-6);
            ASSERT_GE(double(seen.alpha), double(flat.plane(3)[p]) - coverage_rounding);
        }
    }
}

} // namespace
} // namespace sparselens
