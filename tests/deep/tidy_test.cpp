#include "deep/flatten.h"
#include "deep/ldi.h"
#include "deep/tidy.h"
#include "support/composite.h"
#include "support/ldi_samples.h"
#include "support/order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

TestPixel tidied(const TestPixel &pixel) { return samples_of(tidy(ldi_of({pixel})), 0); }

void expect_strictly_ascending(const Ldi &ldi) {
    const Order order = order_of(ldi);
    EXPECT_TRUE(order.sorted && order.apart);
    for (std::size_t pixel = 0; pixel + 1 < ldi.begin.size(); ++pixel)
        for (std::uint64_t i = ldi.begin[pixel] + 1; i < ldi.begin[pixel + 1]; ++i)
            ASSERT_LT(ldi.z[i - 1], ldi.z[i]);
}

TEST(Tidy, SortsPoints) {
    const TestPixel p =
        tidied({{.z = 3, .colour = 0.3f}, {.z = 1, .colour = 0.1f}, {.z = 2, .colour = 0.2f}});
    ASSERT_EQ(p.size(), 3u);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(p[std::size_t(i)].z, float(i + 1));
        EXPECT_EQ(p[std::size_t(i)].colour, float(i + 1) * 0.1f);
    }
}

TEST(Tidy, HandsBackWhatIsTidy) {
    const Ldi ldi = random_ldi({.seed = 3});
    const Ldi same = tidy(ldi);
    EXPECT_EQ(same.begin, ldi.begin);
    EXPECT_EQ(same.z, ldi.z);
    EXPECT_EQ(same.dx, ldi.dx);
    EXPECT_EQ(same.values, ldi.values);
    EXPECT_TRUE(same.z_back.empty());
}

TEST(Tidy, TwiceIsOnce) {
    const Ldi once = tidy(random_ldi({.volume_share = 0.5, .shuffled = true, .depths = 5}));
    const Ldi twice = tidy(once);
    EXPECT_EQ(twice.begin, once.begin);
    EXPECT_EQ(twice.z, once.z);
    EXPECT_EQ(twice.z_back, once.z_back);
    EXPECT_EQ(twice.values, once.values);
}

TEST(Tidy, DropsWhatShowsNothing) {
    EXPECT_TRUE(tidied({{.z = 1, .colour = 0, .alpha = 0}}).empty());
    EXPECT_EQ(tidied({{.z = 1, .colour = 0, .alpha = 0}, {.z = 2}}).size(), 1u);
    EXPECT_EQ(tidied({{.z = 1, .colour = 5, .alpha = 0}}).size(), 1u); // light without coverage
    EXPECT_EQ(tidied({{.z = 1, .colour = 0, .alpha = 1}}).size(), 1u); // black covers
}

// "Interpreting OpenEXR Deep Pixels": each part absorbs 1 - (1 - a)^share and keeps the ratio of colour to alpha.
TEST(Tidy, SplitsAVolumeAtAPointInside) {
    const TestPixel p =
        tidied({{.z = 2, .colour = 0.3f, .alpha = 0.75f, .z_back = 6}, {.z = 3, .colour = 9, .alpha = 0.5f}});
    ASSERT_EQ(p.size(), 3u);
    const double front = 1 - std::pow(0.25, 0.25), back = 1 - std::pow(0.25, 0.75);
    EXPECT_EQ(p[0].z, 2);
    EXPECT_EQ(p[0].z_back, 3);
    EXPECT_NEAR(p[0].alpha, front, 1e-7);
    EXPECT_NEAR(p[0].colour, 0.3 * front / 0.75, 1e-7);
    EXPECT_EQ(p[1].z, 3);
    EXPECT_EQ(p[1].z_back, 3);
    EXPECT_EQ(p[1].alpha, 0.5f);
    EXPECT_EQ(p[1].colour, 9);
    EXPECT_EQ(p[2].z, std::nextafter(3.0f, inf)); // behind the point, so that depths ascend
    EXPECT_EQ(p[2].z_back, 6);
    EXPECT_NEAR(p[2].alpha, back, 1e-7);
    EXPECT_NEAR(p[2].colour, 0.3 * back / 0.75, 1e-7);
}

TEST(Tidy, SplitsLightWithoutCoverageByLengthAndTheOpaqueNotAtAll) {
    const TestPixel light = tidied({{.z = 2, .colour = 8, .alpha = 0, .z_back = 6}, {.z = 3, .alpha = 0.5f}});
    EXPECT_FLOAT_EQ(light[0].colour, 2);
    EXPECT_FLOAT_EQ(light[2].colour, 6);
    const TestPixel opaque =
        tidied({{.z = 2, .colour = 8, .alpha = 1, .z_back = 6}, {.z = 3, .alpha = 0.5f}});
    for (const std::size_t part : {0u, 2u}) {
        EXPECT_EQ(opaque[part].colour, 8);
        EXPECT_EQ(opaque[part].alpha, 1);
    }
}

// Two fogs in one place: optical depths add up, and each gives its colour by its share of them.
TEST(Tidy, MergesVolumesInOnePlace) {
    const TestPixel p = tidied({{.z = 2, .colour = 0.5f, .alpha = 0.5f, .z_back = 4, .weight = 2},
                                {.z = 2, .colour = 0.0f, .alpha = 0.75f, .z_back = 4, .weight = 3}});
    ASSERT_EQ(p.size(), 1u);
    EXPECT_NEAR(p[0].alpha, 0.875, 1e-7);
    EXPECT_NEAR(p[0].colour, 0.875 / 3, 1e-7); // of three half-value layers one is white
    EXPECT_EQ(p[0].weight, 5);
    EXPECT_EQ(p[0].z, 2);
    EXPECT_EQ(p[0].z_back, 4);
}

TEST(Tidy, MergesVolumesWhereTheyOverlap) {
    const TestPixel p =
        tidied({{.z = 1, .alpha = 0.75f, .z_back = 3}, {.z = 2, .alpha = 0.75f, .z_back = 4}});
    ASSERT_EQ(p.size(), 3u);
    EXPECT_NEAR(p[0].alpha, 0.5, 1e-7);
    EXPECT_NEAR(p[1].alpha, 0.75, 1e-7);
    EXPECT_NEAR(p[2].alpha, 0.5, 1e-7);
    EXPECT_EQ(p[1].z, 2);
    EXPECT_EQ(p[1].z_back, 3);
}

TEST(Tidy, MergesPointsOfOneDepth) {
    const TestPixel half =
        tidied({{.z = 2, .colour = 0.5f, .alpha = 0.5f}, {.z = 2, .colour = 0.25f, .alpha = 0.5f}});
    ASSERT_EQ(half.size(), 1u);
    EXPECT_NEAR(half[0].alpha, 0.75, 1e-7);
    EXPECT_NEAR(half[0].colour, 0.75 * 0.75, 1e-7); // both have the mean ratio, 3/4
    const TestPixel opaque =
        tidied({{.z = 2, .colour = 3}, {.z = 2, .colour = 0.3f, .alpha = 0.5f}, {.z = 2, .colour = 5}});
    ASSERT_EQ(opaque.size(), 1u);
    EXPECT_EQ(opaque[0].colour, 4); // the opaque samples share the place
    EXPECT_EQ(opaque[0].alpha, 1);
    const TestPixel light = tidied({{.z = 2, .colour = 3, .alpha = 0}, {.z = 2, .colour = 4, .alpha = 0}});
    ASSERT_EQ(light.size(), 1u);
    EXPECT_EQ(light[0].colour, 7);
}

TEST(Tidy, AtInfinityLiesOneSample) {
    const TestPixel p =
        tidied({{.z = inf, .colour = 1, .alpha = 0.5f}, {.z = 4}, {.z = inf, .colour = 1, .alpha = 0.5f}});
    ASSERT_EQ(p.size(), 2u);
    EXPECT_EQ(p[1].z, inf);
    EXPECT_NEAR(p[1].alpha, 0.75, 1e-7);
    EXPECT_NEAR(p[1].colour, 1.5, 1e-6);
}

TEST(Tidy, AVolumeToInfinityThatOverlapsBecomesAPoint) {
    const TestPixel p =
        tidied({{.z = 1, .alpha = 0.5f, .z_back = inf}, {.z = 4, .alpha = 0.25f, .z_back = 5}});
    ASSERT_EQ(p.size(), 2u);
    EXPECT_EQ(p[0].z_back, 1);
    EXPECT_EQ(p[0].alpha, 0.5f);
    EXPECT_EQ(p[1].alpha, 0.25f);
}

TEST(Tidy, VolumesOneUlpThickStayApart) {
    const float a = 3, b = std::nextafter(a, inf), c = std::nextafter(b, inf);
    expect_strictly_ascending(tidy(ldi_of({{{.z = a, .alpha = 0.5f},
                                            {.z = a, .alpha = 0.5f, .z_back = b},
                                            {.z = b, .alpha = 0.5f},
                                            {.z = b, .alpha = 0.5f, .z_back = c},
                                            {.z = c, .alpha = 0.5f}}})));
}

TEST(Tidy, AlwaysAscendsAndShowsWhatItShowed) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed)
        for (const double volumes : {0.0, 0.3, 1.0})
            for (const int depths : {4, 1 << 20}) {
                const Ldi messy =
                    random_ldi({.seed = seed, .volume_share = volumes, .shuffled = true, .depths = depths});
                const Ldi neat = tidy(messy);
                expect_strictly_ascending(neat);
                const Image picture = flatten(neat);
                for (std::size_t pixel = 0; pixel < messy.windows.pixels(); ++pixel) {
                    const Composite seen = composite(samples_of(messy, pixel));
                    ASSERT_NEAR(picture.plane(0)[pixel], double(seen.colour), 2e-6) << seed;
                    ASSERT_NEAR(picture.plane(3)[pixel], double(seen.alpha), 2e-6) << seed;
                }
            }
}

TEST(Tidy, TheOrderOfSamplesDoesNotMatter) {
    const TestPixel samples = samples_of(
        random_ldi(
            {.seed = 9, .width = 1, .height = 1, .most_samples = 40, .volume_share = 0.5, .depths = 6}),
        0);
    ASSERT_GT(samples.size(), 10u);
    TestPixel backwards(samples.rbegin(), samples.rend());
    const TestPixel a = tidied(samples), b = tidied(backwards);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].z, b[i].z);
        EXPECT_EQ(a[i].z_back, b[i].z_back);
        EXPECT_NEAR(a[i].alpha, b[i].alpha, 1e-6);
        EXPECT_NEAR(a[i].colour, b[i].colour, 1e-6);
    }
}

TEST(Tidy, IdsOfMergedSamplesAreTheFirstOnes) {
    Ldi ldi = ldi_of({{{.z = 5}, {.z = 2, .alpha = 0.5f}, {.z = 2, .alpha = 0.5f}}});
    ldi.channels.push_back({"id", PixelType::uint32});
    ldi.values.push_back({10, 20, 30});
    EXPECT_EQ(tidy(ldi).values[4], (std::vector<float>{20, 10}));
}

TEST(Tidy, WithoutAlphaEverythingIsOpaque) {
    Ldi ldi = ldi_of({{{.z = 5, .colour = 0}, {.z = 2, .colour = 2}, {.z = 2, .colour = 4}}});
    ldi.channels.pop_back();
    ldi.values.pop_back();
    const Ldi neat = tidy(ldi);
    EXPECT_EQ(neat.z, (std::vector<float>{2, 5}));
    EXPECT_EQ(neat.values[0], (std::vector<float>{3, 0}));
}

TEST(Tidy, APixelBecomesTheSameWhateverTheOthersHold) {
    // Higher than the rows processed at once; most pixels have samples of equal depth, some have none.
    const Ldi ldi = random_ldi({.seed = 3, .width = 9, .height = 150, .shuffled = true, .depths = 8});
    const Ldi whole = tidy(ldi);
    EXPECT_LT(whole.samples(), ldi.samples());
    for (std::size_t p = 0; p < ldi.windows.pixels(); ++p) {
        const TestPixel alone = samples_of(tidy(ldi_of({samples_of(ldi, p)})), 0),
                        among = samples_of(whole, p);
        ASSERT_EQ(among.size(), alone.size()) << p;
        for (std::size_t i = 0; i < alone.size(); ++i) {
            EXPECT_EQ(among[i].z, alone[i].z);
            EXPECT_NEAR(double(among[i].alpha), double(alone[i].alpha), 1e-6);
            EXPECT_EQ(among[i].weight, alone[i].weight);
        }
    }
}

} // namespace
} // namespace sparselens
