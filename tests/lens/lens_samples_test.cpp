#include "base/numbers.h"
#include "lens/lens_points.h"
#include "lens/lens_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

namespace sparselens {
namespace {

constexpr std::size_t counts[] = {1, 2, 7, 16, 61, 256, 1024};

struct Means {
    double x = 0, y = 0, xx = 0, yy = 0, pixel_x = 0, pixel_y = 0;
};

// Weighted means; y of the lens is converted back to the unit disc.
Means means_of(const std::vector<LensSample> &samples, double pixel_aspect) {
    Means means;
    double total = 0;
    for (const LensSample &s : samples) {
        const double w = double(s.weight), x = double(s.x), y = double(s.y) / pixel_aspect;
        total += w;
        means.x += w * x;
        means.y += w * y;
        means.xx += w * x * x;
        means.yy += w * y * y;
        means.pixel_x += w * double(s.pixel_x);
        means.pixel_y += w * double(s.pixel_y);
    }
    for (double *mean : {&means.x, &means.y, &means.xx, &means.yy, &means.pixel_x, &means.pixel_y})
        *mean /= total;
    return means;
}

TEST(LensSamples, AreAsManyAsAskedForOfEqualWeightInsideTheDiscAndThePixel) {
    for (const double aspect : {1.0, 2.0, 0.5})
        for (const std::size_t n : counts) {
            const auto samples = disc_lens_samples(n, aspect);
            ASSERT_EQ(samples.size(), n);
            for (const LensSample &s : samples) {
                EXPECT_GT(s.weight, 0);
                EXPECT_EQ(s.weight, samples[0].weight);
                EXPECT_LE(std::hypot(double(s.x), double(s.y) / aspect), 1 + 1e-6);
                EXPECT_GE(s.pixel_x, -0.5f);
                EXPECT_LT(s.pixel_x, 0.5f);
                EXPECT_GE(s.pixel_y, -0.5f);
                EXPECT_LT(s.pixel_y, 0.5f);
            }
        }
}

TEST(LensSamples, OneIsTheMiddleOfTheLensAndOfThePixel) {
    const LensSample s = disc_lens_samples(1, 2).front();
    EXPECT_EQ(s.x, 0);
    EXPECT_EQ(s.y, 0);
    EXPECT_EQ(s.pixel_x, 0);
    EXPECT_EQ(s.pixel_y, 0);
}

// The picture does not move, and spreads equally in all directions: the moments of the disc, E x = 0, E x^2 = 1/4.
TEST(LensSamples, HaveTheMomentsOfTheDisc) {
    for (const double aspect : {1.0, 2.0})
        for (const std::size_t n : {16u, 61u, 256u, 1024u}) {
            const Means means = means_of(disc_lens_samples(n, aspect), aspect);
            const double tolerance = 0.8 / std::pow(double(n), 0.75); // better than random points, n^-0.5
            EXPECT_NEAR(means.x, 0, tolerance) << n;
            EXPECT_NEAR(means.y, 0, tolerance) << n;
            EXPECT_NEAR(means.xx, 0.25, tolerance) << n;
            EXPECT_NEAR(means.yy, 0.25, tolerance) << n;
            EXPECT_NEAR(means.pixel_x, 0, tolerance) << n;
            EXPECT_NEAR(means.pixel_y, 0, tolerance) << n;
        }
}

// The share of points on one side of any line equals the disc's share there.
TEST(LensSamples, AreEvenInArea) {
    constexpr std::size_t n = 256;
    const auto samples = disc_lens_samples(n, 1);
    for (int k = 0; k < 24; ++k)
        for (const double distance : {-0.8, -0.3, 0.0, 0.5}) {
            const double angle = k * std::numbers::pi / 12, x = std::cos(angle), y = std::sin(angle);
            const auto beyond = std::ranges::count_if(
                samples, [&](const LensSample &s) { return x * double(s.x) + y * double(s.y) > distance; });
            const double share =
                (std::acos(distance) - distance * std::sqrt(1 - distance * distance)) / std::numbers::pi;
            EXPECT_NEAR(double(beyond) / n, share, 0.02) << k << ' ' << distance;
        }
}

// In every part of the lens the pixel positions are uniform too: about a sixteenth of the points is in a given quarter
// of the lens and quarter of the pixel.
TEST(LensSamples, AreEvenOverLensAndPixelAtOnce) {
    constexpr std::size_t n = 1024;
    int count[2][2][2][2] = {};
    for (const LensSample &s : disc_lens_samples(n, 1))
        ++count[s.x > 0][s.y > 0][s.pixel_x > 0][s.pixel_y > 0];
    for (int i = 0; i < 16; ++i)
        EXPECT_NEAR(count[i & 1][i >> 1 & 1][i >> 2 & 1][i >> 3], n / 16.0, 0.15 * n / 16) << i;
}

TEST(LensSamples, AreStretchedByThePixelAspect) {
    const auto round = disc_lens_samples(64, 1), tall = disc_lens_samples(64, 2);
    for (std::size_t i = 0; i < 64; ++i) {
        EXPECT_EQ(tall[i].x, round[i].x);
        EXPECT_NEAR(tall[i].y, 2 * round[i].y, 1e-6);
    }
}

constexpr int phases = 3; // positions of a sample in its pixel, along each axis

using Weights = std::map<std::pair<int, int>, double>; // pixel -> weight

// The exact weights of pixels for the disc of a sample at `place`: the sum of a lens point and a pixel position is a
// unit square.
Weights exact_disc(double coc, const Imath::V2d &place) {
    constexpr int points = 4000;
    Weights weights;
    for (const Imath::V2d &u : spiral_lens_points(points)) {
        const Imath::V2d at = coc * u + place - Imath::V2d(0.5);
        const int x = int(std::floor(at.x)), y = int(std::floor(at.y));
        const double s = at.x - x, t = at.y - y;
        weights[{x, y}] += (1 - s) * (1 - t) / points;
        weights[{x + 1, y}] += s * (1 - t) / points;
        weights[{x, y + 1}] += (1 - s) * t / points;
        weights[{x + 1, y + 1}] += s * t / points;
    }
    return weights;
}

// The sum of squared errors of these weights for a set of lens points.
double squared_error(const std::vector<Imath::V2d> &positions, double coc, const Imath::V2d &place) {
    Weights errors = exact_disc(coc, place);
    const std::vector<Imath::V2d> lens = spiral_lens_points(int(positions.size()));
    for (std::size_t k = 0; k < lens.size(); ++k) {
        const Imath::V2d at = coc * lens[k] + positions[k] - Imath::V2d(0.5) + place;
        errors[{int(std::floor(at.x)), int(std::floor(at.y))}] -= 1 / double(lens.size());
    }
    double sum = 0;
    for (const auto &[pixel, error] : errors) sum += error * error;
    return sum;
}

// Over discs from focus to a size at which most pixels meet one lens point or none, for any positions.
double mean_error(const std::vector<Imath::V2d> &positions) {
    double sum = 0;
    for (double coc = 0.5; coc <= 12; coc *= 1.3)
        for (int y = 0; y < phases; ++y)
            for (int x = 0; x < phases; ++x)
                sum += squared_error(positions, coc, (Imath::V2d(x, y) + Imath::V2d(0.5)) / phases);
    return sum;
}

std::vector<Imath::V2d> sequence(std::size_t n) {
    std::vector<Imath::V2d> positions;
    for (std::uint32_t k = 0; k < n; ++k) positions.push_back(low_discrepancy_2d(k, {0.5, 0.5}));
    return positions;
}

// The numbers of points of final quality, which have steps of their own.
constexpr std::size_t own_numbers[] = {288, 384, 480, 576};

TEST(PixelPositions, OfTheGathersSetsLeaveLessErrorThanTheSequence) {
    for (const std::size_t n : own_numbers)
        EXPECT_LT(mean_error(pixel_positions(n)), mean_error(sequence(n))) << n;
}

// Over all discs, within a decibel.
TEST(PixelPositions, ThreeDoForFour) {
    double own = 0, of_sequence = 0;
    for (const std::size_t n : own_numbers) {
        own += mean_error(pixel_positions(n));
        of_sequence += mean_error(sequence(n * 4 / 3));
    }
    EXPECT_LT(own, 1.26 * of_sequence);
}

TEST(PixelPositions, LieInThePixelEvenlyAndBeginInTheMiddle) {
    std::vector<std::size_t> numbers(std::begin(own_numbers), std::end(own_numbers));
    for (const std::size_t n : {1u, 7u, 100u, 4096u}) numbers.push_back(n);
    for (const std::size_t n : numbers) {
        const std::vector<Imath::V2d> positions = pixel_positions(n);
        ASSERT_EQ(positions.size(), n);
        EXPECT_EQ(positions.front(), Imath::V2d(0.5));
        Imath::V2d sum(0);
        for (const Imath::V2d &p : positions) {
            ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1) << n;
            sum += p;
        }
        EXPECT_NEAR(sum.x / double(n), 0.5, 0.8 / std::pow(double(n), 0.75)) << n;
        EXPECT_NEAR(sum.y / double(n), 0.5, 0.8 / std::pow(double(n), 0.75)) << n;
    }
}

TEST(PixelPositions, OfOtherNumbersAreTheSequence) {
    for (std::size_t n = 1; n < 1000; ++n)
        EXPECT_EQ(pixel_positions(n) == sequence(n), !std::ranges::binary_search(own_numbers, n)) << n;
}

} // namespace
} // namespace sparselens
