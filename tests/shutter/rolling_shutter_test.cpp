// The rows of a rolling shutter, whose weights are integrals in closed form.
#include "shutter/shutter_mean.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace sparselens {
namespace {

constexpr int rows = 12;
constexpr double durations[] = {0.001, 0.1, 0.25, 0.3, 0.75, 0.999};

// The integral of a triangle of height 1 from the time it opens.
double triangle_until(double time) {
    const double t = std::clamp(time, 0.0, 1.0);
    return t < 0.5 ? t * t : 0.5 - (1 - t) * (1 - t);
}
double box_until(double time) { return std::clamp(time, 0.0, 1.0); }

TEST(RollingShutter, ExposesFromTheTopToTheBottom) {
    for (const double duration : durations) {
        const ShutterPart top = exposure_of_row(0, rows, duration),
                          bottom = exposure_of_row(rows - 1, rows, duration);
        EXPECT_NEAR(top.from, (1 - duration) / rows / 2, 1e-12); // the middle of the row is half a row lower
        EXPECT_NEAR(bottom.to, 1 - (1 - duration) / rows / 2, 1e-12);
        for (int row = 0; row < rows; ++row) {
            const ShutterPart part = exposure_of_row(row, rows, duration);
            EXPECT_NEAR(part.to - part.from, duration, 1e-12);
            EXPECT_NEAR(part.from, top.from + (bottom.from - top.from) * row / (rows - 1), 1e-12);
        }
        EXPECT_EQ(exposure_of_row(-7, rows, duration).from, top.from);
        EXPECT_EQ(exposure_of_row(rows + 3, rows, duration).from, bottom.from);
    }
}

TEST(RollingShutter, WeightsAreIntegralsOfTheCurveOfEachRow) {
    for (const double duration : durations)
        for (const int moments : {1, 4, 7}) {
            const auto box = row_weights(box_shutter(), moments, duration, rows),
                       triangle = row_weights(triangle_shutter(), moments, duration, rows);
            for (int row = 0; row < rows; ++row) {
                const double from = exposure_of_row(row, rows, duration).from;
                const auto own = [&](int m) { return (double(m) / moments - from) / duration; };
                double box_sum = 0, triangle_sum = 0; // weights count relative to their sum
                for (int m = 0; m < moments; ++m) {
                    box_sum += box[std::size_t(m)][std::size_t(row)];
                    triangle_sum += triangle[std::size_t(m)][std::size_t(row)];
                }
                for (int m = 0; m < moments; ++m) {
                    const double begin = own(m), end = own(m + 1);
                    EXPECT_NEAR(box[std::size_t(m)][std::size_t(row)] / box_sum,
                                box_until(end) - box_until(begin), 1e-9);
                    EXPECT_NEAR(triangle[std::size_t(m)][std::size_t(row)] / triangle_sum,
                                (triangle_until(end) - triangle_until(begin)) / triangle_until(1), 1e-9);
                }
            }
        }
}

// Floats hold the weights of a curve in any unit, and the same picture follows.
TEST(RollingShutter, TheUnitOfTheCurveDoesNotMatter) {
    const auto wanted = row_weights(triangle_shutter(), 4, 0.3, rows);
    for (const double unit : {0x1p1000, 0x1p-1000, 0x1p-1060}) {
        ShutterCurve curve = triangle_shutter();
        for (ShutterCurve::Point &point : curve.points) point.value *= unit;
        const auto weights = row_weights(curve, 4, 0.3, rows);
        for (int row = 0; row < rows; ++row)
            for (std::size_t m = 0; m < 4; ++m)
                EXPECT_NEAR(weights[m][std::size_t(row)], wanted[m][std::size_t(row)], 1e-3) << unit;
    }
    ShutterCurve needle; // narrower than doubles tell in the exposure of a row
    needle.points = {{0, 0}, {0.5, 0}, {0.5 + 1e-16, 1}, {0.5 + 2e-16, 0}, {1, 0}};
    const auto weights = row_weights(needle, 4, 0.001, rows);
    for (int row = 0; row < rows; ++row) {
        double sum = 0;
        for (std::size_t m = 0; m < 4; ++m) sum += weights[m][std::size_t(row)];
        EXPECT_GE(sum, 1);
    }
}

TEST(RollingShutter, OfTheWholeTimeHasTheWeightsOfNone) {
    for (const ShutterCurve &curve : {box_shutter(), triangle_shutter(), gaussian_shutter()})
        for (const int moments : {1, 3, 8, 11}) {
            const std::vector<double> all = moment_weights(curve, moments);
            const auto weights = row_weights(curve, moments, 1, rows);
            const int exponent = std::ilogb(*std::ranges::max_element(all));
            for (std::size_t m = 0; m < all.size(); ++m)
                EXPECT_EQ(weights[m], std::vector<double>(rows, std::ldexp(all[m], -exponent)));
        }
}

TEST(RollingShutter, EachRowSeesAllLensPoints) {
    for (const int moments : {1, 4, 7, 16})
        for (const double duration : {0.001, 0.25, 0.6, 1.0}) {
            const int shares = share_of_moment(0, moments, duration).moments;
            EXPECT_NEAR(shares, std::max(1.0, moments * duration), 0.5);
            for (int first = 0; first + shares <= moments; ++first) {
                std::set<int> seen;
                for (int m = first; m < first + shares; ++m)
                    seen.insert(share_of_moment(m, moments, duration).moment);
                EXPECT_EQ(int(seen.size()), shares);
                EXPECT_LT(*seen.rbegin(), shares);
            }
        }
    for (int m = 0; m < 5; ++m) {
        EXPECT_EQ(share_of_moment(m, 5, 1).moment, m);
        EXPECT_EQ(share_of_moment(m, 5, 1).moments, 5);
    }
}

} // namespace
} // namespace sparselens
