#include "base/light.h"
#include "deep/flatten.h"
#include "support/ldi_samples.h"
#include "support/order.h"
#include "support/views.h"
#include "warp/silhouettes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr double scale = 20; // of depths 2 and 10: 8 pixels of CoC apart

Ldi separated(const View &view, double jump = 0.5) {
    ViewSamples samples(view, view.image.channels);
    separate_silhouettes(samples, scale, jump);
    return samples.as_ldi();
}

void expect_flattens_to(const View &view, const Ldi &ldi) {
    const Image flat = flatten(ldi);
    for (std::size_t i = 0; i < flat.values.size(); ++i) {
        const bool empty = view.image.plane(3)[i % flat.windows.pixels()] == 0;
        const float value = empty ? 0 : view.image.values[i];
        EXPECT_NEAR(flat.values[i], value, 1e-6 * std::max(1.0, std::abs(double(value))));
    }
}

// A vertical edge inside column 8: red at depth 2 to the left, green at depth `far_z` to the right. The column itself
// shows `share` of red, with the depth of the surface at its centre.
View edge(float share, float far_z = 10) {
    return make_view(windows_of_size(16, 9), {0, 0}, [&](int x, int) {
        const float red = x < 8 ? 1 : x == 8 ? share : 0;
        return ViewPixel{.z = red >= 0.5f ? 2 : far_z, .r = red, .g = 1 - red};
    });
}

TEST(Silhouettes, MixedPixelsAreTakenApart) {
    for (const float share : {0.25f, 0.4f, 0.6f, 0.75f}) {
        const View view = edge(share);
        const Ldi ldi = separated(view);
        expect_flattens_to(view, ldi);
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 16; ++x) {
                const std::size_t pixel = std::size_t(y * 16 + x);
                const std::uint64_t front = ldi.pixel(pixel).front(), behind = front + 1;
                ASSERT_EQ(ldi.pixel(pixel).size(), x == 8 ? 2u : 1u) << x;
                if (x != 8) continue;
                EXPECT_FLOAT_EQ(ldi.z[front], 2);
                EXPECT_FLOAT_EQ(ldi.z[behind], 10);
                const float front_rgba[] = {share, 0, 0, share}, behind_rgba[] = {0, 1, 0, 1};
                for (std::size_t k = 0; k < 4; ++k) {
                    // Mixed pixels influence the front's colour, and "not mixed" influences the share.
                    EXPECT_NEAR(ldi.values[k][front], front_rgba[k], 0.05);
                    EXPECT_NEAR(ldi.values[k][behind], behind_rgba[k], 1e-6);
                }
            }
    }
}

// The same edge before a veil whose density differs in every column.
TEST(Silhouettes, VeilsBehindAnEdgeKeepTheirCoverage) {
    const auto density = [](int x) { return 0.1f + 0.07f * float(x * 5 % 7); };
    for (const float share : {0.25f, 0.6f}) {
        const View view = make_view(windows_of_size(16, 9), {0, 0}, [&](int x, int) {
            const float red = x < 8 ? 1 : x == 8 ? share : 0, green = (1 - red) * density(x);
            return ViewPixel{.z = red >= 0.5f ? 2.f : 10.f, .r = red, .g = green, .a = red + green};
        });
        const Ldi ldi = separated(view);
        expect_flattens_to(view, ldi);
        const std::uint64_t front = ldi.pixel(4 * 16 + 8).front();
        ASSERT_EQ(ldi.pixel(4 * 16 + 8).size(), 2u);
        EXPECT_FLOAT_EQ(ldi.z[front], 2);
        EXPECT_FLOAT_EQ(ldi.z[front + 1], 10);
        EXPECT_NEAR(ldi.values[3][front], share, 1e-6);
        EXPECT_NEAR(ldi.values[1][front], 0, 1e-6);
        EXPECT_NEAR(ldi.values[3][front + 1], density(8), 1e-6);
        EXPECT_EQ(ldi.samples(), 16u * 9 + 9);
    }
}

TEST(Silhouettes, TheSkyIsASurfaceToo) {
    const Ldi ldi = separated(edge(0.4f, inf));
    const std::uint64_t front = ldi.pixel(4 * 16 + 8).front();
    ASSERT_EQ(ldi.pixel(4 * 16 + 8).size(), 2u);
    EXPECT_EQ(ldi.z[front], 2);
    EXPECT_EQ(ldi.z[front + 1], inf);
}

TEST(Silhouettes, PixelsOfOneSurfaceAreLeftAlone) {
    for (const float share : {0.0f, 1.0f}) {
        const View view = edge(share); // a clean edge
        EXPECT_EQ(separated(view).samples(), 16u * 9);
    }
    const View slope = make_view(windows_of_size(16, 9), {0, 0}, [](int x, int y) {
        return ViewPixel{.z = 5 + 0.1f * float(x), .r = float(x % 2), .g = float(y % 2)};
    });
    EXPECT_EQ(separated(slope).samples(), 16u * 9); // no depth step, whatever the colours
}

TEST(Silhouettes, TheJumpSaysWhatPartsSurfaces) {
    EXPECT_EQ(separated(edge(0.4f), 7.9).samples(), 17u * 9);
    EXPECT_EQ(separated(edge(0.4f), 8.1).samples(), 16u * 9);
}

// Where front and back have the same colour, or a colour is outside their range, nothing is separated.
TEST(Silhouettes, WhatCannotBeToldIsLeftAlone) {
    const View grey = make_view(windows_of_size(16, 9), {0, 0}, [](int x, int) {
        return ViewPixel{.z = x < 8 ? 2.0f : 10.0f, .r = 0.5f, .g = 0.5f, .b = 0.5f};
    });
    EXPECT_EQ(separated(grey).samples(), 16u * 9);
    View odd = edge(0.5f);
    for (int y = 0; y < 9; ++y) odd.image.at(2, 8, y) = 5; // blue, of which neither side has any
    EXPECT_EQ(separated(odd).samples(), 16u * 9);
}

// Behind the post that ends inside column 8 there is a lamp in columns 8 and 9 of rows 3 to 5, and a grey wall
// elsewhere. The post's pixels contain the lamp's light too, but the mean of the pixels clear of the post does not.
TEST(Silhouettes, ALampHalfBehindAPostShinesAtItsOwnDepth) {
    const float lamp = 500, share = 0.6f;
    const View view = make_view(windows_of_size(16, 9), {0, 0}, [&](int x, int y) {
        const float behind = x >= 8 && x <= 9 && y >= 3 && y <= 5 ? lamp : 0.5f;
        const float red = x < 8 ? 0.1f : x == 8 ? share * 0.1f + (1 - share) * behind : behind;
        return ViewPixel{.z = x <= 8 ? 2.0f : 10.0f, .r = red, .g = red, .b = red};
    });
    const Ldi ldi = separated(view);
    expect_flattens_to(view, ldi);
    for (int y = 3; y <= 5; ++y) {
        const SampleRange samples = ldi.pixel(ldi.windows.index(Imath::V2i(8, y)));
        const std::uint64_t front = samples.front();
        ASSERT_EQ(samples.size(), 2u) << y;
        EXPECT_FLOAT_EQ(ldi.values[0][front + 1], lamp);
        EXPECT_NEAR(ldi.values[3][front], share, 0.04); // the lamp influences the post's colour
        EXPECT_LT(ldi.values[0][front], 0.04f * lamp);
    }
}

// A post on the left, and on the right a board with a lamp behind its lower edge, whose last row is half lamp: behind
// the post's edge the board shows its own colour, not the lamp at the board's depth.
TEST(Silhouettes, WhatIsMixedItselfTellsLittleOfWhatLiesBehind) {
    const View view = make_view(windows_of_size(16, 9), {0, 0}, [](int x, int y) {
        if (x < 7) return ViewPixel{.z = 2, .r = 0.1f, .g = 0.1f};
        if (x == 7) return ViewPixel{.z = 2, .r = 0.2f, .g = 0.2f};
        if (y > 4) return ViewPixel{.z = 10, .r = 40, .g = 40};
        const float v = y == 4 ? 20 : 0.3f;
        return ViewPixel{.z = 4, .r = v, .g = v};
    });
    const Ldi ldi = separated(view);
    expect_flattens_to(view, ldi);
    for (int y = 0; y < 4; ++y) {
        const SampleRange pixel = ldi.pixel(std::size_t(y * 16 + 7));
        ASSERT_EQ(pixel.size(), 2u) << y;
        const std::uint64_t board = pixel.front() + 1;
        EXPECT_FLOAT_EQ(ldi.z[board], 4) << y;
        EXPECT_LT(ldi.values[0][board], 1.0f) << y; // 5 if all pixels counted equally
    }
}

// Bright letters with a slanted edge before the sky. Pixels beside the edge have the depth of the sky; a letter covers
// a twentieth of some of them, and nothing of the others.
TEST(Silhouettes, TheSkyBesideBrightLettersHasNoDarkEdge) {
    const Imath::V3f letter(7.5f, 10.5f, 15), sky(0.5f, 0.45f, 0.55f);
    const View view = make_view(windows_of_size(20, 12), {0, 0}, [&](int x, int y) {
        const float share = x < 5 + y ? 1 : x == 5 + y ? 0.05f : 0;
        const Imath::V3f c = share * letter + (1 - share) * sky;
        return ViewPixel{.z = share == 1 ? 2 : inf, .r = c.x, .g = c.y, .b = c.z};
    });
    const Ldi ldi = separated(view);
    expect_flattens_to(view, ldi);
    EXPECT_EQ(ldi.samples(), 20u * 12 + 12);
    for (std::uint64_t i = 0; i < ldi.samples(); ++i)
        for (int k = 0; k < 3; ++k) {
            const float colour = ldi.values[std::size_t(k)][i] / ldi.values[3][i];
            EXPECT_NEAR(colour, ldi.z[i] == 2 ? letter[k] : sky[k], 0.01f * colour) << i;
        }
}

// In a lamp of three by three pixels one pixel is pure; the mixed colours of its edges are not its colour.
TEST(Silhouettes, TheEdgesOfASmallLampArePartsOfIt) {
    const auto share = [](int x, int y) {
        const float across = x == 4 ? 1 : x == 3 ? 0.6f : x == 5 ? 0.4f : 0;
        const float down = y == 4 ? 1 : y == 3 || y == 5 ? 0.5f : 0;
        return across * down;
    };
    const View view = make_view(windows_of_size(9, 9), {0, 0}, [&](int x, int y) {
        return ViewPixel{.z = share(x, y) >= 0.5f ? 2.0f : 10.0f, .r = 0.1f + 500 * share(x, y)};
    });
    const Ldi ldi = separated(view);
    expect_flattens_to(view, ldi);
    double nearer = 0, farther = 0;
    for (std::uint64_t i = 0; i < ldi.samples(); ++i)
        (ldi.z[i] < 5 ? nearer : farther) += double(ldi.values[0][i]);
    for (std::size_t pixel = 0; pixel < 81; ++pixel) {
        const float part = share(int(pixel % 9), int(pixel / 9));
        if (part == 0 || part == 1) continue;
        EXPECT_NEAR(ldi.values[3][ldi.pixel(pixel).front()], part, 0.02) << pixel;
    }
    EXPECT_NEAR(nearer, 500 * 2 * 2, 10);
    EXPECT_NEAR(farther, 0.1 * 81, 1);
}

TEST(Silhouettes, WhatAMixedPixelLeavesOpenStaysOpen) {
    View view = edge(0.5f);
    for (int y = 0; y < 9; ++y)
        for (std::size_t k = 0; k < 4; ++k) view.image.at(k, 8, y) *= 0.9f;
    const Ldi ldi = separated(view);
    expect_flattens_to(view, ldi);
    const std::uint64_t front = ldi.pixel(8).front();
    ASSERT_EQ(ldi.pixel(8).size(), 2u);
    EXPECT_NEAR(ldi.values[3][front], 0.45, 1e-6);
    EXPECT_NEAR(ldi.values[3][front + 1], 0.45 / 0.55, 1e-6);
}

TEST(Silhouettes, FlattenedEveryPictureIsWhatItWas) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        View view =
            random_view({Imath::Box2i({0, 0}, {19, 9}), Imath::Box2i({-2, 3}, {17, 30})}, {0, 0}, seed);
        for (float &alpha : view.image.plane(3))
            if (is_opaque(alpha)) alpha = 1; // a coverage of .9996 would count as 1, and not flatten to 1
        const Ldi ldi = separated(view);
        EXPECT_TRUE(order_of(ldi).sorted && order_of(ldi).apart);
        expect_flattens_to(view, ldi);
    }
}

// Negative colours and NaNs: no such pixel spoils another one.
TEST(Silhouettes, BadPixelsStayOnePixel) {
    for (const float bad : {-1.0f, std::nanf(""), inf, -inf}) {
        View view = edge(0.4f);
        view.image.at(0, 8, 4) = bad;
        view.image.at(1, 5, 4) = bad;
        view.image.at(0, 9, 2) = bad;
        const Ldi ldi = separated(view);
        const Image flat = flatten(ldi);
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 16; ++x) {
                const bool own =
                    std::isfinite(view.image.at(0, x, y)) && std::isfinite(view.image.at(1, x, y));
                EXPECT_EQ(std::isfinite(flat.at(0, x, y)) && std::isfinite(flat.at(1, x, y)), own)
                    << x << "," << y;
            }
    }
}

TEST(Silhouettes, WithoutColourOrCoverageNothingHappens) {
    View view = edge(0.4f);
    view.image.channels[0].name = "Y";
    EXPECT_EQ(separated(view).samples(), 16u * 9);
    view = edge(0.4f);
    view.image.channels[3].name = "Y";
    EXPECT_EQ(separated(view).samples(), 16u * 9);
}

// Views without empty pixels use a faster algorithm: one empty pixel in a corner changes only its surroundings.
TEST(Silhouettes, AnEmptyPixelChangesWhatIsAroundItAlone) {
    const auto views_of = [](bool with_empty) {
        View view = random_view(windows_of_size(40, 30), {0, 0}, 11);
        const std::size_t alpha = find_channel(view.image.channels, "A");
        for (float &a : view.image.plane(alpha)) a = 1;
        if (with_empty) view.image.plane(alpha)[0] = 0;
        return separated(view);
    };
    const Ldi full = views_of(false), other = views_of(true);
    int split = 0;
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            if (x < 10 && y < 10) continue; // strands that tell a colour are up to 8 pixels away
            const std::size_t pixel = full.windows.index(Imath::V2i(x, y));
            ASSERT_EQ(full.pixel(pixel).size(), other.pixel(pixel).size()) << x << ' ' << y;
            split += full.pixel(pixel).size() > 1;
            for (std::uint64_t i = 0; i < full.pixel(pixel).size(); ++i) {
                ASSERT_EQ(full.z[full.pixel(pixel).from + i], other.z[other.pixel(pixel).from + i]);
                ASSERT_EQ(full.values[0][full.pixel(pixel).from + i],
                          other.values[0][other.pixel(pixel).from + i]);
            }
        }
    EXPECT_GT(split, 20);
}

} // namespace
} // namespace sparselens
