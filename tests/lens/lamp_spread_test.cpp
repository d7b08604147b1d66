#include "lens/lamp_spread.h"
#include "lens/psf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sparselens {
namespace {

using Points = std::vector<Imath::V2d>;

// The area of a polygon inside a box, by clipping it at each side (I. Sutherland and G. Hodgman, 1974).
double area_in(Points polygon, const Imath::Box2d &box) {
    for (const int axis : {0, 1})
        for (const int side : {0, 1}) {
            const double limit = side ? box.max[axis] : box.min[axis];
            const auto inside = [&](const Imath::V2d &p) {
                return side ? p[axis] <= limit : p[axis] >= limit;
            };
            Points kept;
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const Imath::V2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
                if (inside(a)) kept.push_back(a);
                if (inside(a) != inside(b))
                    kept.push_back(a + (b - a) * ((limit - a[axis]) / (b[axis] - a[axis])));
            }
            polygon = kept;
        }
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Imath::V2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::abs(twice) / 2;
}

// The corners of a regular polygon as a lamp shows it, with the middle of a side at the angle `rotation`.
Points corners(int n, double rotation, double squeeze, const Lamp &lamp) {
    Points points;
    for (int k = 0; k < n; ++k) {
        const double at = (rotation / 180 + (2 * k + 1.0) / n) * std::numbers::pi;
        points.emplace_back(lamp.centre.x + lamp.coc * std::cos(at) / squeeze,
                            lamp.centre.y - lamp.coc * std::sin(at) * lamp.pixel_aspect);
    }
    return points;
}

constexpr int size = 64;

// The weights of a square of pixels, collected from tiles as in the gather.
std::vector<double> picture_of(const ApertureShape &shape, const Lamp &lamp) {
    const Aperture aperture(shape);
    std::vector<double> weights(size * size);
    for (int tile = 0; tile < 4; ++tile) {
        const Imath::V2i corner(tile % 2 * size / 2, tile / 2 * size / 2);
        const LampSpread spread = spread_lamp(aperture, lamp, {corner, corner + Imath::V2i(size / 2 - 1)});
        std::size_t i = 0;
        for (int y = spread.box.min.y; y <= spread.box.max.y && !spread.box.isEmpty(); ++y)
            for (int x = spread.box.min.x; x <= spread.box.max.x; ++x)
                weights[std::size_t(y * size + x)] = spread.weights[i++];
    }
    return weights;
}

double sum(const std::vector<double> &weights) {
    double all = 0;
    for (const double w : weights) all += w;
    return all;
}

std::shared_ptr<AperturePicture> picture(int width, int height, const std::function<float(int, int)> &grey) {
    auto made = std::make_shared<AperturePicture>(AperturePicture{width, height, {}});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) made->rgb.insert(made->rgb.end(), 3, grey(x, y));
    return made;
}

const Lamp lamps[] = {
    {{31.5, 32.5}, 12}, {{30.2, 33.9}, -9.7}, {{32.01, 31.3}, 2.3}, {{31.8, 32.4}, 11, 1.4}};

TEST(LampSpread, OfBladesIsTheAreaOfThePolygonInEachPixel) {
    for (const Lamp &lamp : lamps)
        for (const int blades : {3, 5, 6, 16})
            for (const double squeeze : {1.0, 2.0, 0.6}) {
                const auto weights = picture_of({.blades = blades, .rotation = 17, .squeeze = squeeze}, lamp);
                const Points shape = corners(blades, 17, squeeze, lamp);
                const double area = area_in(shape, {Imath::V2d(-1e3), Imath::V2d(1e3)});
                for (int y = 0; y < size; ++y)
                    for (int x = 0; x < size; ++x)
                        ASSERT_NEAR(weights[std::size_t(y * size + x)] * area,
                                    area_in(shape, {Imath::V2d(x, y), Imath::V2d(x + 1, y + 1)}), 1e-9)
                            << blades << " " << x << "," << y;
                EXPECT_NEAR(sum(weights), 1, 1e-9);
            }
}

TEST(LampSpread, OfRoundBladesIsThatOfTheDisc) {
    for (const Lamp &lamp : lamps)
        for (const ApertureShape &shape : {ApertureShape{.blades = 7, .curvature = 1, .spherical = 1e-12},
                                           ApertureShape{.blades = 5, .curvature = 1 - 1e-9}}) {
            const auto weights = picture_of(shape, lamp);
            const double radius = std::abs(lamp.coc),
                         area = std::numbers::pi * radius * radius * lamp.pixel_aspect;
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x)
                    ASSERT_NEAR(area * weights[std::size_t(y * size + x)],
                                area * psf_weight({lamp.centre, radius, lamp.pixel_aspect}, x, y), 1e-3)
                        << x << "," << y;
            EXPECT_NEAR(sum(weights), 1, 1e-4);
        }
}

TEST(LampSpread, BulgesWithTheCurvatureOfTheBlades) {
    // The arc of a side over a square: its height over the chord is `curvature` times the circle's.
    const Lamp lamp{{32, 32}, 24};
    const double height = 0.4 * (1 - std::sqrt(0.5));
    const auto weights = picture_of({.blades = 4, .curvature = 0.4}, lamp);
    const double edge = 32 + 24 * (std::sqrt(0.5) + height); // where the disc ends to the right
    EXPECT_GT(weights[std::size_t(32 * size + int(edge))], 0);
    EXPECT_EQ(weights[std::size_t(32 * size + int(edge) + 1)], 0);
    EXPECT_NEAR(sum(weights), 1, 1e-9);
}

TEST(LampSpread, IsTheSameTurnedByABlade) {
    for (const int blades : {3, 6, 11})
        for (const double curvature : {0.0, 0.5}) {
            const ApertureShape shape{.blades = blades, .curvature = curvature, .rotation = 10};
            ApertureShape turned = shape;
            turned.rotation += 360.0 / blades;
            const auto a = picture_of(shape, lamps[0]), b = picture_of(turned, lamps[0]);
            for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-12);
        }
}

TEST(LampSpread, InFrontOfFocusIsThePointMirrorOfBehind) {
    const auto behind = picture_of({.blades = 3, .rotation = 90}, {{32, 32}, 20}),
               in_front = picture_of({.blades = 3, .rotation = 90}, {{32, 32}, -20});
    for (std::size_t i = 0; i < behind.size(); ++i)
        ASSERT_NEAR(behind[i], in_front[behind.size() - 1 - i], 1e-12);
    // Behind focus a side is on top, because y points up there.
    EXPECT_GT(behind[std::size_t(23 * size + 20)], 0);
    EXPECT_EQ(behind[std::size_t(40 * size + 20)], 0);
}

TEST(LampSpread, WeighsRadiiAsTheSphericalAberrationSays) {
    for (const double spherical : {0.8, -0.5})
        for (const double coc : {10.3, -10.3}) {
            const Lamp lamp{{31.7, 32.2}, coc};
            const ApertureShape shape{.blades = 6, .rotation = 12, .spherical = spherical};
            const auto weights = picture_of(shape, lamp);
            EXPECT_NEAR(sum(weights), 1, 1e-6);
            const double s = coc > 0 ? spherical : -spherical;
            // Pixels well inside: compares the density at their middle with the mean of r^2 over a square beside it.
            const auto within = [&](int x, int y) {
                const double r2 =
                    (std::pow(x + 0.5 - lamp.centre.x, 2) + std::pow(y + 0.5 - lamp.centre.y, 2) + 1.0 / 6) /
                    (coc * coc);
                return 1 + s * (2 * r2 - 1);
            };
            const double scale = weights[32 * size + 32] / within(32, 32);
            for (int y = 27; y <= 37; ++y)
                for (int x = 27; x <= 37; ++x)
                    ASSERT_NEAR(weights[std::size_t(y * size + x)] / scale, within(x, y), 1e-9);
        }
}

// Each colour has the shares of an aperture whose colours are all like it; coverage has those of green.
TEST(LampSpread, HasTheRimsOfEachColour) {
    const ByColour rims{-0.7, 0.2, 1};
    const auto grey = picture(3, 3, [](int x, int y) { return float(1 + x + (y == 1 ? 4 : 0)); });
    const Imath::Box2i box{{0, 0}, Imath::V2i(size - 1)};
    for (const double coc : {10.3, -7.1})
        for (ApertureShape shape :
             {ApertureShape{}, ApertureShape{.blades = 5, .squeeze = 1.4}, ApertureShape{.picture = grey}}) {
            const Lamp lamp{{31.7, 32.2}, coc};
            shape.spherical = rims;
            const LampSpread spread = spread_lamp(Aperture(shape), lamp, box);
            ASSERT_TRUE(spread.coloured);
            for (const std::size_t k : {0u, 1u, 2u}) {
                shape.spherical = rims[k];
                const LampSpread alike = spread_lamp(Aperture(shape), lamp, box);
                for (std::size_t i = 0; i < alike.weights.size(); ++i) {
                    ASSERT_NEAR(spread.colours[i][k], alike.weights[i], 1e-15);
                    if (k == 1 && !shape.picture) {
                        ASSERT_EQ(spread.weights[i], alike.weights[i]);
                    }
                }
            }
        }
}

TEST(LampSpread, OfAPictureIsItsLightInEachPixel) {
    // A cross of 3 x 3 squares whose middle is twice as bright; 24 pixels wide, so that a square is 8 pixels.
    const auto cross = picture(5, 5, [](int x, int y) {
        if (x == 2 && y == 2) return 2.0f;
        return (x == 2 && y >= 1 && y <= 3) || (y == 2 && x >= 1 && x <= 3) ? 1.0f : 0.0f;
    });
    const Lamp lamp{{32, 32}, 12};
    const auto weights = picture_of({.picture = cross}, lamp);
    EXPECT_NEAR(sum(weights), 1, 1e-12);
    EXPECT_NEAR(weights[32 * size + 32], 2.0 / 6 / 64, 1e-12);
    EXPECT_NEAR(weights[22 * size + 32], 1.0 / 6 / 64, 1e-12);
    EXPECT_NEAR(weights[22 * size + 22], 0, 1e-15);
    for (const Lamp &moved : lamps)
        EXPECT_NEAR(sum(picture_of({.squeeze = 1.7, .picture = cross}, moved)), 1, 1e-9);
}

TEST(LampSpread, OfAPictureIsTheAreaOfItsSquaresInEachPixelWhereverItLies) {
    const auto grey = [](int x, int y) { return float(1 + 3 * x + (y == 1 ? 4 : 0)); };
    const auto squares = picture(3, 3, grey);
    const double all = 3 * (1 + 4 + 7) + 3 * 4;
    for (const Lamp &lamp : lamps)
        for (const double squeeze : {1.0, 2.0, 0.7}) {
            const auto weights = picture_of({.squeeze = squeeze, .picture = squares}, lamp);
            const Imath::V2d side(2.0 / 3 * lamp.coc / squeeze, 2.0 / 3 * lamp.coc * lamp.pixel_aspect);
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) {
                    const Imath::Box2d pixel(Imath::V2d(x, y), Imath::V2d(x + 1, y + 1));
                    double light = 0;
                    for (int i = 0; i < 9; ++i) {
                        const Imath::V2d a = lamp.centre + side * Imath::V2d(i % 3 - 1.5, i / 3 - 1.5),
                                         b = a + side;
                        light += double(grey(i % 3, i / 3)) * area_in({a, {b.x, a.y}, b, {a.x, b.y}}, pixel);
                    }
                    const double square = std::abs(side.x * side.y);
                    ASSERT_NEAR(weights[std::size_t(y * size + x)] * all * square, light, 1e-3)
                        << x << "," << y;
                }
            EXPECT_NEAR(sum(weights), 1, 1e-4);
        }
}

TEST(LampSpread, OfAPictureIsUprightBehindFocus) {
    const auto half = picture(2, 2, [](int x, int y) { return x == 0 && y == 0 ? 3.0f : 1.0f; });
    const auto behind = picture_of({.picture = half}, {{32, 32}, 10}),
               in_front = picture_of({.picture = half}, {{32, 32}, -10});
    EXPECT_NEAR(behind[30 * size + 30], 3 * behind[34 * size + 34], 1e-12);
    EXPECT_NEAR(in_front[34 * size + 34], 3 * in_front[30 * size + 30], 1e-12);
}

TEST(LampSpread, OfAColouredPictureSumsTo1OfEachColour) {
    auto tinted = picture(8, 8, [](int x, int y) { return float(1 + x + y); });
    for (std::size_t i = 0; i < tinted->rgb.size(); i += 3) tinted->rgb[i] = float(i), tinted->rgb[i + 2] = 5;
    const LampSpread spread =
        spread_lamp(Aperture({.picture = tinted}), {{32.3, 30.8}, 14}, {{0, 0}, {63, 63}});
    ASSERT_TRUE(spread.coloured);
    std::array<double, 3> sums{};
    for (const auto &rgb : spread.colours)
        for (std::size_t k = 0; k < 3; ++k) sums[k] += rgb[k];
    for (const double s : sums) EXPECT_NEAR(s, 1, 1e-9);
}

// A disc of 1e4 pixels seen in one tile costs no more, and is as exact, as a small one.
TEST(LampSpread, OfAHugeDiscIsEvenWithinIt) {
    const Aperture aperture({.blades = 6, .curvature = 0.3});
    const LampSpread spread = spread_lamp(aperture, {{1000, -700}, 1e4}, {{0, 0}, {63, 63}});
    ASSERT_EQ(spread.weights.size(), 4096u);
    for (const double w : spread.weights) ASSERT_NEAR(w, spread.weights[0], 1e-14);
    EXPECT_NEAR(spread.weights[0], 1 / (2.75 * 1e8), 0.06e-8);
}

} // namespace
} // namespace sparselens
