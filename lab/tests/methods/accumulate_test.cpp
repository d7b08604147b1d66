#include "base/error.h"
#include "lab/methods/accumulate.h"
#include "lab/methods/parabolic_shift.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace sparselens {
namespace {

using Line = std::vector<double>;

double at(const Line &line, int i) { return line[std::size_t(std::clamp(i, 0, int(line.size()) - 1))]; }

// Colella and Woodward's parabola of pixel i in their notation: its values at both edges, with their three cases.
struct Parabola {
    double left, right, mean;

    Parabola(const Line &line, int i) : mean(at(line, i)) {
        const auto edge = [&](int k) { // between k - 1 and k
            const double value =
                7.0 / 12 * (at(line, k - 1) + at(line, k)) - (at(line, k - 2) + at(line, k + 1)) / 12;
            return std::clamp(value, std::min(at(line, k - 1), at(line, k)),
                              std::max(at(line, k - 1), at(line, k)));
        };
        left = edge(i), right = edge(i + 1);
        const double difference = right - left, bend = 6 * (mean - (left + right) / 2);
        if ((right - mean) * (mean - left) <= 0)
            left = right = mean;
        else if (difference * bend > difference * difference)
            left = 3 * mean - 2 * right;
        else if (-difference * difference > difference * bend)
            right = 3 * mean - 2 * left;
    }
    double value(double x) const {
        return left + x * (right - left + 6 * (mean - (left + right) / 2) * (1 - x));
    }
    // Simpson's rule is exact for parabolas.
    double integral(double a, double b) const {
        return (b - a) / 6 * (value(a) + 4 * value((a + b) / 2) + value(b));
    }
};

// Pixel x of the line whose pixels cover [x - shift, x - shift + 1) of `line`.
Line moved_reference(const Line &line, double shift) {
    const double whole = std::floor(-shift), part = -shift - whole;
    Line result(line.size());
    for (int x = 0; x < int(line.size()); ++x) {
        const int i = x + int(whole);
        result[std::size_t(x)] =
            Parabola(line, i).integral(part, 1) + Parabola(line, i + 1).integral(0, part);
    }
    return result;
}

Image one_channel(int width, int height) { return Image(windows_of_size(width, height), {{"R"}}); }

Image noise(int width, int height, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    Image image = one_channel(width, height);
    for (float &v : image.values) v = uniform(generator);
    return image;
}

Image moved(const Image &image, Imath::V2d shift) {
    Accumulation sum = start_accumulation(image.windows, image.channels);
    accumulate(sum, image, shift, "view.exr");
    return average(sum);
}

TEST(ParabolicShift, OverAWholePixelIsItsValue) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < 1000; ++i) {
        const float a = uniform(generator), b = uniform(generator), c = uniform(generator),
                    d = uniform(generator), e = uniform(generator);
        EXPECT_NEAR(integral_inside(a, b, c, d, e, 1), c, 1e-6);
        EXPECT_EQ(integral_inside(a, b, c, d, e, 0), 0);
    }
}

TEST(Accumulate, AgreesWithTheParabolasAsPublished) {
    const int width = 23, height = 17;
    const Image image = noise(width, height, 2);
    for (const Imath::V2d &shift : {Imath::V2d(0.3, -0.8), Imath::V2d(-2.5, 1.25), Imath::V2d(0.999, 0)}) {
        std::vector<Line> rows(height, Line(width));
        for (int x = 0; x < width; ++x) { // first along y, then along x
            Line column;
            for (int y = 0; y < height; ++y) column.push_back(double(image.at(0, x, y)));
            const Line result = moved_reference(column, shift.y);
            for (std::size_t y = 0; y < rows.size(); ++y) rows[y][std::size_t(x)] = result[y];
        }
        const Image fast = moved(image, shift);
        for (int y = 3; y < height - 3; ++y) {
            const Line expected = moved_reference(rows[std::size_t(y)], shift.x);
            for (int x = 3; x < width - 3; ++x)
                EXPECT_NEAR(fast.at(0, x, y), expected[std::size_t(x)], 2e-6) << x << ' ' << y;
        }
    }
}

TEST(Accumulate, WholePixelsAndConstantsAreExact) {
    const Image image = noise(12, 9, 3), result = moved(image, {3, -2});
    for (int y = 0; y < 7; ++y)
        for (int x = 3; x < 12; ++x) EXPECT_EQ(result.at(0, x, y), image.at(0, x - 3, y + 2));
    Image grey = one_channel(12, 9);
    std::ranges::fill(grey.values, 0.3f);
    for (const float v : moved(grey, {0.37, -0.41}).values) EXPECT_EQ(v, 0.3f);
}

TEST(Accumulate, ASlopeMovesExactly) {
    Image slope = one_channel(20, 20);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) slope.at(0, x, y) = 0.5f * float(x) + 0.25f * float(y);
    const Image result = moved(slope, {0.3, 0.6});
    for (int y = 4; y < 16; ++y)
        for (int x = 4; x < 16; ++x)
            EXPECT_NEAR(result.at(0, x, y), 0.5 * (x - 0.3) + 0.25 * (y - 0.6), 1e-5);
}

TEST(Accumulate, ALampKeepsItsEnergyAndGetsNoRing) {
    Image lamp = one_channel(21, 21);
    std::ranges::fill(lamp.values, 0.25f);
    lamp.at(0, 10, 10) = 100;
    lamp.at(0, 11, 10) = 60;
    for (const Imath::V2d &shift : {Imath::V2d(0.5, 0.5), Imath::V2d(-0.2, 0.9), Imath::V2d(2.3, -1.6)}) {
        const Image result = moved(lamp, shift);
        double energy = 0;
        for (int y = 4; y < 17; ++y)
            for (int x = 4; x < 17; ++x) {
                energy += result.at(0, x, y) - 0.25;
                EXPECT_GE(result.at(0, x, y), 0.25f - 1e-5f);
                EXPECT_LE(result.at(0, x, y), 100);
            }
        EXPECT_NEAR(energy, 99.75 + 59.75, 1e-4);
    }
}

TEST(Accumulate, ALampMovesRightAndDownByTheShift) {
    Image lamp = one_channel(21, 21);
    lamp.at(0, 10, 10) = 1;
    for (const Imath::V2d &shift : {Imath::V2d(0.5, 0.5), Imath::V2d(-0.2, 0.9), Imath::V2d(2.3, -1.6)}) {
        const Image result = moved(lamp, shift);
        Imath::V2d centre(0, 0);
        for (int y = 0; y < 21; ++y)
            for (int x = 0; x < 21; ++x) centre += Imath::V2d(x, y) * double(result.at(0, x, y));
        EXPECT_NEAR(centre.x, 10 + shift.x, 1e-5);
        EXPECT_NEAR(centre.y, 10 + shift.y, 1e-5);
    }
}

TEST(Accumulate, ExtremeValuesStayFinite) {
    Image image = one_channel(9, 1);
    image.values = {0, 1e30f, -1e30f, 65504, 1e-40f, 1e36f, 0, 0, 1e30f};
    for (const float v : moved(image, {0.4, 0}).values) EXPECT_TRUE(std::isfinite(v));
}

TEST(Accumulate, EqualWeightsOverTheViewsThatCoverAPixel) {
    Image dark = one_channel(10, 6), bright = one_channel(10, 6);
    std::ranges::fill(dark.values, 1.0f);
    std::ranges::fill(bright.values, 4.0f);
    Accumulation sum = start_accumulation(dark.windows, dark.channels);
    accumulate(sum, dark, {0, 0}, "dark.exr");
    accumulate(sum, bright, {2.4, 0}, "bright.exr"); // covers pixels from x = 2 on: 2.5 >= 2.4
    accumulate(sum, bright, {0, -1.5}, "up.exr");    // covers pixels with y + 0.5 < 6 - 1.5
    const Image result = average(sum);
    EXPECT_EQ(result.at(0, 1, 0), 2.5f);
    EXPECT_EQ(result.at(0, 2, 0), 3);
    EXPECT_EQ(result.at(0, 1, 4), 1);
    EXPECT_EQ(result.at(0, 2, 4), 2.5f);
    EXPECT_EQ(result.at(0, 1, 3), 2.5f);
}

TEST(Accumulate, WhatNoViewCoversIsTransparentBlack) {
    Image image = one_channel(6, 6);
    std::ranges::fill(image.values, 1.0f);
    const Image result = moved(image, {3, 0});
    EXPECT_EQ(result.at(0, 2, 3), 0);
    EXPECT_EQ(result.at(0, 3, 3), 1);
    for (const Imath::V2d &far : {Imath::V2d(1e12, 0), Imath::V2d(0, -1e300), Imath::V2d(6.6, 0)})
        for (const float v : moved(image, far).values) EXPECT_EQ(v, 0);
}

TEST(Accumulate, ViewsOfOtherDataWindowsLieWhereTheyBelong) {
    Image crop(Windows{{{0, 0}, {9, 9}}, {{4, 2}, {7, 5}}, 1}, {{"R"}});
    std::iota(crop.values.begin(), crop.values.end(), 1.0f);
    Accumulation sum = start_accumulation(windows_of_size(10, 10), crop.channels);
    accumulate(sum, crop, {1, 2}, "crop.exr");
    const Image result = average(sum);
    EXPECT_EQ(result.at(0, 5, 4), 1);
    EXPECT_EQ(result.at(0, 8, 7), 16);
    EXPECT_EQ(result.at(0, 4, 4), 0);
    EXPECT_EQ(result.at(0, 8, 8), 0);
}

TEST(Accumulate, ThousandsOfViewsAddNoError) {
    Image image = one_channel(4, 4);
    std::ranges::fill(image.values, 0.1f);
    Accumulation sum = start_accumulation(image.windows, image.channels);
    for (int i = 0; i < 5000; ++i) accumulate(sum, image, {0, 0}, "view.exr");
    for (const float v : average(sum).values) EXPECT_EQ(v, 0.1f);
}

TEST(Accumulate, IdsComeFromTheFirstViewUnmoved) {
    Image first(windows_of_size(3, 1), {{"R"}, {"id", PixelType::uint32}}), second = first;
    const std::uint32_t id = 0x7fc00001; // a NaN, read as a float
    first.at(1, 1, 0) = std::bit_cast<float>(id);
    second.at(1, 1, 0) = std::bit_cast<float>(5u);
    Accumulation sum = start_accumulation(first.windows, first.channels);
    EXPECT_EQ(fill_nonfinite(first, sum.channels), 0u);
    accumulate(sum, first, {1, 0}, "first.exr");
    accumulate(sum, second, {0, 0}, "second.exr");
    const Image result = average(sum);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(result.at(1, 1, 0)), id);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(result.at(1, 0, 0)), 0u);
}

TEST(Accumulate, DepthIsLeftOutButNotWhatIsOnlyCalledZ) {
    const std::vector<Channel> channels{{"R"},         {"Z"},        {"ZBack"},         {"depth.Z"},
                                        {"a.Depth.Z"}, {"normal.Z"}, {"a.Depth.ZBack"}, {"P.Z"}};
    const Accumulation sum = start_accumulation(windows_of_size(1, 1), channels);
    EXPECT_EQ(sum.channels, (std::vector<Channel>{{"R"}, {"normal.Z"}, {"P.Z"}}));
}

TEST(Accumulate, AMissingChannelIsAnErrorNamingViewAndChannel) {
    const Image first(windows_of_size(2, 2), {{"R"}, {"A"}}), second(windows_of_size(2, 2), {{"R"}});
    Accumulation sum = start_accumulation(first.windows, first.channels);
    try {
        accumulate(sum, second, {0, 0}, "second.exr");
        FAIL();
    } catch (const Error &error) {
        EXPECT_STREQ(error.what(), "second.exr: has no channel A");
    }
    const Image ids(windows_of_size(2, 2), {{"R"}, {"A", PixelType::uint32}});
    EXPECT_THROW(accumulate(sum, ids, {0, 0}, "ids.exr"), Error);
}

TEST(Accumulate, BadValuesAreFilledFromTheirNeighboursAndCounted) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                    inf = std::numeric_limits<float>::infinity();
    Image image(windows_of_size(4, 2), {{"R"}, {"Z", PixelType::float32}});
    image.values = {1, nan, inf, 3, 5, 6, 7, 8, inf, inf, inf, inf, inf, inf, inf, inf};
    EXPECT_EQ(fill_nonfinite(image, {{"R"}}), 2u);
    EXPECT_FLOAT_EQ(image.values[1], (1 + 5 + 6 + 7) / 4.0f); // without the other bad value
    EXPECT_FLOAT_EQ(image.values[2], (3 + 6 + 7 + 8) / 4.0f);
    EXPECT_EQ(image.values[8], inf); // its channel was not named
    EXPECT_EQ(fill_nonfinite(image, {{"R"}, {"Z"}}), 8u);
    EXPECT_EQ(image.values[8], 0);
}

TEST(Accumulate, TransparentSurroundingsFillTheDisplayWindow) {
    Image crop(Windows{{{0, 0}, {3, 3}}, {{2, 2}, {5, 2}}, 1}, {{"R"}});
    std::ranges::fill(crop.values, 1.0f);
    const Image whole = with_transparent_surroundings(crop);
    EXPECT_EQ(whole.windows.data, Imath::Box2i({0, 0}, {5, 3}));
    EXPECT_EQ(whole.at(0, 5, 2), 1);
    EXPECT_EQ(whole.at(0, 2, 1), 0);
}

TEST(Accumulate, SameAtAnyThreadCount) {
    const Image image = noise(70, 90, 7);
    const auto run = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        Accumulation sum = start_accumulation(image.windows, image.channels);
        for (int i = 0; i < 5; ++i) accumulate(sum, image, {0.37 * i, -0.71 * i}, "view.exr");
        return average(sum);
    };
    EXPECT_EQ(run(1).values, run(4).values);
}

// Checks the header's claim about the filter: views in focus, box-filtered, and moved back by their displacement.
TEST(Accumulate, AnEdgeInFocusStaysSharperThanLinearInterpolationMakesIt) {
    const int width = 24, views = 64;
    const double edge = 11.3;
    const auto coverage = [&](double x) { return std::clamp(x + 1 - edge, 0.0, 1.0); }; // of pixel [x, x + 1)
    Accumulation sum = start_accumulation(windows_of_size(width, 1), {{"R"}});
    std::vector<double> linear(width);
    for (int v = 0; v < views; ++v) {
        const double shift = 4 * std::sin(2.4 * v);
        Image view = one_channel(width, 1);
        for (int x = 0; x < width; ++x) view.at(0, x, 0) = float(coverage(x + shift));
        accumulate(sum, view, {shift, 0}, "view.exr");
        for (int x = 6; x < width - 6; ++x) {
            const double from = x - shift, part = from - std::floor(from);
            const int i = int(std::floor(from));
            linear[std::size_t(x)] += ((1 - part) * view.at(0, i, 0) + part * view.at(0, i + 1, 0)) / views;
        }
    }
    const Image result = average(sum);
    double error = 0, linear_error = 0;
    for (int x = 6; x < width - 6; ++x) {
        error += std::pow(result.at(0, x, 0) - coverage(x), 2);
        linear_error += std::pow(linear[std::size_t(x)] - coverage(x), 2);
    }
    EXPECT_LT(error, 0.5 * linear_error);
}

} // namespace
} // namespace sparselens
