#include "base/numbers.h"
#include "lens/psf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace sparselens {
namespace {

double random_unit(std::uint32_t index, std::uint32_t stream) {
    return unit_interval(mix_bits(index, stream));
}

struct Weight {
    int x, y;
    double value;
};

// All weights that PsfRows gives for a PSF, box by box.
std::vector<Weight> fast_weights(const Psf &psf) {
    constexpr int size = PsfRows::max_size;
    const double ry = psf.radius * psf.pixel_aspect;
    const int left = int(std::floor(psf.centre.x - psf.radius)) - 1,
              right = int(psf.centre.x + psf.radius) + 2;
    const int top = int(std::floor(psf.centre.y - ry)) - 1, bottom = int(psf.centre.y + ry) + 2;
    std::vector<Weight> all;
    std::array<double, size> weights;
    for (int y0 = top; y0 <= bottom; y0 += size)
        for (int x0 = left; x0 <= right; x0 += size) {
            const PsfRows rows(psf,
                               {{x0, y0}, {std::min(x0 + size - 1, right), std::min(y0 + size - 1, bottom)}});
            for (int y = rows.begin_row(); y < rows.end_row(); ++y) {
                const auto [begin, end] = rows.row(y, weights.data());
                for (int x = begin; x < end; ++x) all.push_back({x, y, weights[std::size_t(x - x0)]});
            }
        }
    return all;
}

double disc_area(const Psf &psf) { return std::numbers::pi * psf.radius * psf.radius * psf.pixel_aspect; }

TEST(Psf, ClosedForms) {
    const Psf quarter{{0, 0}, 1, 1}; // centre on a corner: a quarter for each pixel
    EXPECT_NEAR(psf_weight(quarter, 0, 0), 0.25, 1e-12);
    EXPECT_NEAR(psf_weight(quarter, -1, 0), 0.25, 1e-12);
    EXPECT_EQ(psf_weight(quarter, 1, 0), 0);
    const Psf inside{{3.5, 4.5}, 0.25, 1};
    EXPECT_NEAR(psf_weight(inside, 3, 4), 1, 1e-12);
    EXPECT_EQ(psf_weight(inside, 4, 4), 0);
    const Psf wide{{0.5, 0.5}, 10, 1};
    EXPECT_NEAR(psf_weight(wide, 2, 3), 1 / (100 * std::numbers::pi), 1e-15);
    // Pixel [1, 2] x [0, 1] of the disc of radius 2: full up to x = sqrt(3), then the integral of sqrt(4 -
    // x^2).
    const double edge = std::sqrt(3.0), beyond = std::numbers::pi / 3 - edge / 2;
    EXPECT_NEAR(psf_weight({{0, 0}, 2, 1}, 1, 0) * 4 * std::numbers::pi, edge - 1 + beyond, 1e-12);
    // An ellipse twice as high as wide covers the same as the disc does in pixels of half the height.
    const Psf tall{{0, 0}, 1.5, 2};
    EXPECT_NEAR(psf_weight(tall, 0, 2) + psf_weight(tall, 0, 3), psf_weight({{0, 0}, 1.5, 1}, 0, 1), 1e-12);
}

TEST(Psf, ClosedFormAgreesWithCounting) {
    constexpr int grid = 1000;
    for (std::uint32_t i = 0; i < 20; ++i) {
        const Psf psf{{random_unit(i, 1), random_unit(i, 2)}, 0.3 + 3 * random_unit(i, 3), i % 2 ? 1 : 1.7};
        const int x = int(4 * random_unit(i, 4)) - 1, y = int(4 * random_unit(i, 5)) - 1;
        int hits = 0;
        for (int a = 0; a < grid; ++a)
            for (int b = 0; b < grid; ++b) {
                const double dx = x + (a + 0.5) / grid - psf.centre.x;
                const double dy = (y + (b + 0.5) / grid - psf.centre.y) / psf.pixel_aspect;
                hits += dx * dx + dy * dy < psf.radius * psf.radius;
            }
        EXPECT_NEAR(psf_weight(psf, x, y) * disc_area(psf), double(hits) / (grid * grid), 1e-4) << i;
    }
}

TEST(Psf, FastWeightsAreTheExactOnes) {
    for (std::uint32_t i = 0; i < 400; ++i) {
        const double radius = std::pow(10, -3 + 4.5 * random_unit(i, 1));
        const Psf psf{{5 * random_unit(i, 2) - 2, 5 * random_unit(i, 3) - 2},
                      radius,
                      i % 3 ? 1 : 0.5 + random_unit(i, 4)};
        const double unit = std::min(1.0, disc_area(psf)); // the largest weight times the disc's area
        const int reach = int(radius * std::max(1.0, psf.pixel_aspect)) + 5, width = 2 * reach + 1;
        std::vector<double> fast(std::size_t(width) * std::size_t(width), 0.0);
        const auto index = [&](int x, int y) { return std::size_t((y + reach) * width + x + reach); };
        for (const Weight &weight : fast_weights(psf)) fast[index(weight.x, weight.y)] = weight.value;
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                ASSERT_NEAR(fast[index(x, y)] * disc_area(psf), psf_weight(psf, x, y) * disc_area(psf),
                            1e-6 * unit)
                    << "radius " << radius << " centre " << psf.centre << " pixel " << x << "," << y;
                ASSERT_GE(fast[index(x, y)], 0);
            }
    }
}

TEST(Psf, BordersOfHugeDiscsAreExact) {
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const double radius = std::pow(10, 1 + 3 * random_unit(i, 1)),
                     angle = 2 * std::numbers::pi * random_unit(i, 2);
        const Psf psf{{random_unit(i, 3), random_unit(i, 4)}, radius, 1};
        const int x = int(std::floor(psf.centre.x + radius * std::cos(angle)));
        const int y = int(std::floor(psf.centre.y + radius * std::sin(angle)));
        const Imath::Box2i box({x - 2, y - 2}, {x + 2, y + 2});
        const PsfRows rows(psf, box);
        std::vector<double> weights(PsfRows::max_size);
        for (int row = rows.begin_row(); row < rows.end_row(); ++row) {
            const auto [begin, end] = rows.row(row, weights.data());
            for (int column = begin; column < end; ++column)
                ASSERT_NEAR(weights[std::size_t(column - x + 2)] * disc_area(psf),
                            psf_weight(psf, column, row) * disc_area(psf), 1e-6)
                    << "radius " << radius;
        }
    }
}

TEST(Psf, WeightsSumToOne) {
    std::vector<double> radii{0,    1e-300, 1e-12, 1e-6, 1e-3, 0.1, 0.499, 0.5,
                              0.51, 1,      1.5,   2,    3.7,  10,  100,   1000};
    for (const double radius : radii)
        for (std::uint32_t i = 0; i < (radius > 2000 ? 1u : radius > 50 ? 2u : 40u); ++i) {
            const Imath::V2d centre(i < 4 ? i * 0.5 : random_unit(i, 1), i < 4 ? i / 2 : random_unit(i, 2));
            double sum = 0;
            for (const Weight &weight : fast_weights({centre, radius, i % 2 ? 1 : 1.3})) sum += weight.value;
            EXPECT_NEAR(sum, 1, 1e-5) << "radius " << radius << " centre " << centre;
        }
}

TEST(Psf, CentreOfMassIsTheCentre) {
    for (const double radius : {0.2, 0.9, 4.3, 17.0}) {
        const Psf psf{{2.3, -1.8}, radius, 0.7};
        double x = 0, y = 0;
        for (const Weight &weight : fast_weights(psf)) {
            x += weight.value * (weight.x + 0.5);
            y += weight.value * (weight.y + 0.5);
        }
        // A pixel's light counts at its centre: correct to within what the border pixels average out.
        EXPECT_NEAR(x, psf.centre.x, radius < 1 ? 0.35 : 0.01);
        EXPECT_NEAR(y, psf.centre.y, radius < 1 ? 0.35 : 0.01);
    }
}

TEST(Psf, PointFallsIntoThePixelThatHoldsIt) {
    const std::vector<Weight> weights = fast_weights({{7.99, -3.01}, 0, 1});
    ASSERT_EQ(weights.size(), 1u);
    EXPECT_EQ(weights[0].x, 7);
    EXPECT_EQ(weights[0].y, -4);
    EXPECT_EQ(weights[0].value, 1);
    EXPECT_EQ(psf_weight({{7.99, -3.01}, 0, 1}, 7, -4), 1);
}

TEST(Psf, RowsStayWithinTheirBox) {
    for (std::uint32_t i = 0; i < 200; ++i) {
        const Psf psf{{40 * random_unit(i, 1) - 20, 40 * random_unit(i, 2) - 20},
                      i % 5 ? 30 * random_unit(i, 3) : 0,
                      1};
        const Imath::Box2i box({-4, -3}, {5, 6});
        const PsfRows rows(psf, box);
        ASSERT_GE(rows.begin_row(), -3);
        ASSERT_LE(rows.end_row(), 7);
        for (int y = rows.begin_row(); y < rows.end_row(); ++y) {
            std::vector<double> weights(10 + 2, -1.0);
            const auto [begin, end] = rows.row(y, weights.data() + 1);
            ASSERT_GE(begin, -4);
            ASSERT_LE(end, 6);
            for (int x = -5; x <= 6; ++x) ASSERT_EQ(weights[std::size_t(x + 5)] == -1, x < begin || x >= end);
        }
    }
}

} // namespace
} // namespace sparselens
