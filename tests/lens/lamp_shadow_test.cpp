#include "lens/lamp_shadow.h"
#include "support/ldi_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sparselens {
namespace {

const Imath::Box2i box({3, -2}, {14, 9});

double overlap(float low, float high, int pixel) {
    return std::max(0.0, std::min(double(high), pixel + 1.0) - std::max(double(low), double(pixel)));
}

Imath::Box2f random_rectangle(int seed) {
    const auto random = [&](int k, float span) { return span * float(random_unit(seed, k, 3)); };
    const Imath::V2f corner(random(0, 14) + 1, random(1, 14) - 4);
    return {corner, corner + Imath::V2f(random(2, 3), random(3, 3))};
}

TEST(LampShadow, HidesTheAreaOfARectangle) {
    for (int seed = 0; seed < 200; ++seed) {
        LampShadow shadow;
        shadow.begin(box);
        const Imath::Box2f r = random_rectangle(seed);
        shadow.hide(r, 1, 0);
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int x = box.min.x; x <= box.max.x; ++x) {
                const double hidden = overlap(r.min.x, r.max.x, x) * overlap(r.min.y, r.max.y, y);
                ASSERT_NEAR(double(shadow.lit(x, y)), 1 - hidden, 0.06) << x << " " << y;
            }
    }
}

// An object that moves along an axis hides one point after the other.
TEST(LampShadow, ChangesByOnePointAtATime) {
    for (const bool across : {true, false}) {
        float last = 1;
        for (int step = 0; step <= 256; ++step) {
            const float edge = float(step) / 256;
            LampShadow shadow;
            shadow.begin(box);
            shadow.hide(
                across ? Imath::Box2f({0, -9}, {5 + edge, 19}) : Imath::Box2f({0, -9}, {19, 2 + edge}), 1, 0);
            const float lit = shadow.lit(5, 2);
            ASSERT_NEAR(lit, 1 - edge, 1.0f / 64);
            ASSERT_LE(last - lit, 1.0f / 64 + 1e-6f);
            last = lit;
        }
        EXPECT_EQ(last, 0);
    }
}

// In a pixel that a disc's edge crosses, only points inside the disc count as lit or not.
TEST(LampShadow, CountsWhatLiesInADisc) {
    const LampDisc disc{{5, 5}, {3, 3}}, wide{{5, 5}, {9, 9}};
    for (const float edge : {7.25f, 7.5f, 7.75f}) {
        LampShadow shadow;
        shadow.begin(box);
        shadow.hide({{edge, -9}, {19, 19}}, 1, 0);
        int inside = 0, lit = 0; // in pixel (7, 5)
        for (int i = 0; i < 10000; ++i) {
            const double x = 7 + (i % 100 + 0.5) / 100, y = 5 + (i / 100 + 0.5) / 100;
            inside += disc.contains(x, y);
            lit += disc.contains(x, y) && x < double(edge);
        }
        EXPECT_NEAR(double(shadow.lit(7, 5, &disc)), double(lit) / inside, 0.02) << edge;
        EXPECT_EQ(shadow.lit(7, 5, &wide), shadow.lit(7, 5));
        EXPECT_EQ(shadow.lit(4, 5, &disc), 1);
    }
}

TEST(LampShadow, OfTwoHidesWhatEitherHides) {
    const Imath::V2i moved(2, -1);
    const auto at = [](float x, float y, const Imath::V2i &by) {
        return Imath::Box2f(Imath::V2f(by), Imath::V2f(by) + Imath::V2f(x, y));
    };
    LampShadow one, other, both;
    one.begin(box);
    both.begin(box);
    other.begin({box.min - Imath::V2i(2), box.max + Imath::V2i(2)});
    for (LampShadow *shadow : {&one, &both}) {
        shadow->hide(at(3.3f, 19, {0, 0}), 1, 0);
        shadow->hide(at(19, 2, {0, 0}), 0.1f, 2); // a veil
    }
    other.hide(at(19, 5.6f, {0, 0}), 0.5f, 1);
    other.hide(at(2.5f, 19, {0, 0}), 0.05f, 3);
    both.hide(at(19, 5.6f, moved), 0.5f, 1);
    both.hide(at(2.5f, 19, moved), 0.05f, 3);
    one.add(other, moved);
    const LampDisc disc{{3, 4}, {2, 2}};
    for (int y = 2; y < 7; ++y)
        for (int x = 2; x < 5; ++x) {
            EXPECT_EQ(one.lit(x, y), both.lit(x, y));
            EXPECT_EQ(one.lit(x, y, &disc), both.lit(x, y, &disc));
        }
    EXPECT_FALSE(one.dark());
    other.hide(at(99, 99, {-9, -9}), 1, 4);
    one.add(other, moved);
    EXPECT_TRUE(one.dark());
}

TEST(LampShadow, JoinsNeighboursWithoutACrackAndCountsNothingTwice) {
    LampShadow shadow;
    shadow.begin(box);
    for (int k = 0; k < 40; ++k) {
        const float from = 4 + 0.17f * float(k);
        shadow.hide({{from, 1.3f}, {from + 0.17f, 4.6f}}, 1, std::uint32_t(k));
        shadow.hide({{from, 1.3f}, {from + 0.17f, 4.6f}}, 1, std::uint32_t(k));
    }
    for (int x = 5; x < 10; ++x) {
        EXPECT_EQ(shadow.lit(x, 2), 0);
        EXPECT_NEAR(shadow.lit(x, 1), 0.3f, 0.02f);
    }
}

TEST(LampShadow, LetsThroughWhatIsNotCovered) {
    for (const float alpha : {0.03f, 0.1f, 0.4f, 0.75f, 0.96f}) {
        double mean = 0, behind_another = 0;
        for (std::uint32_t thing = 0; thing < 64; ++thing) {
            LampShadow shadow;
            shadow.begin(box);
            shadow.hide({{0, -9}, {20, 20}}, alpha, thing);
            EXPECT_NEAR(shadow.lit(6, 6), 1 - alpha, 1.0f / 128 + 1e-5f) << thing;
            mean += double(shadow.lit(6, 6)) / 64;
            shadow.hide({{0, -9}, {20, 20}}, alpha, thing * 31 + 7);
            behind_another += double(shadow.lit(6, 6)) / 64;
        }
        EXPECT_NEAR(mean, 1 - double(alpha), 1.0 / 128 + 1e-5);
        EXPECT_NEAR(behind_another, std::pow(1 - double(alpha), 2), 0.03) << alpha;
    }
}

// In front of focus the disc is turned by half a turn, which three blades show.
TEST(LampCells, ShineAsTheDiscIsSpread) {
    const Aperture blades(ApertureShape{.blades = 3});
    const Imath::Box2i around({0, 0}, {23, 23});
    for (const double coc : {7.0, -7.0}) {
        const Lamp lamp{{12.2, 11.6}, coc};
        const LampLight light = LampCells(blades, coc > 0).shine(lamp, 0, nullptr, around);
        const LampSpread spread = spread_lamp(blades, lamp, around);
        double off = 0;
        std::size_t i = 0;
        for (int y = spread.box.min.y; y <= spread.box.max.y; ++y)
            for (int x = spread.box.min.x; x <= spread.box.max.x; ++x)
                off += std::abs(double(light.whole[light.at(x, y)][3]) - spread.weights[i++]);
        EXPECT_LT(off, 0.05) << coc;
    }
}

// Compared with the definition, point by point: the lamp at q is hidden through u = (q - x) / c if x' + c' u covers q.
TEST(ShadowMagnification, IsWhatSimilarTrianglesSay) {
    for (const double lamp_coc : {12.0, -9.0})
        for (const double coc : {-14.0, 0.0, 3.0}) {
            const double lamp = 5.3, thing = 8.1, m = shadow_magnification(lamp_coc, coc);
            const double q = lamp + m * (thing - lamp), u = (q - lamp) / lamp_coc;
            EXPECT_NEAR(thing + coc * u, q, 1e-12);
        }
}

} // namespace
} // namespace sparselens
