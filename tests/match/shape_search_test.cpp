#include "lens/lens_looks.h"
#include "match/patterns.h"
#include "match/shape_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sparselens {
namespace {

constexpr int width = 112, height = 80;

// Whether an aperture passes the light at this point; x right, y up, in radii of the f-number's circle.
bool passes(const ApertureShape &shape, double x, double y) {
    x *= shape.squeeze;
    if (shape.blades == 0) return x * x + y * y <= 1;
    const double turn = 2 * std::numbers::pi / shape.blades;
    for (int i = 0; i < shape.blades; ++i) {
        const double at = shape.rotation * std::numbers::pi / 180 + i * turn;
        if (x * std::cos(at) + y * std::sin(at) > std::cos(turn / 2)) return false;
    }
    return true;
}

struct Lamp {
    double x, y, depth; // disparity
};
constexpr std::array all_lamps{Lamp{19.3, 18.7, 4}, Lamp{56.1, 22.2, 2}, Lamp{92.6, 19.5, 3},
                               Lamp{20.8, 58.4, 3}, Lamp{57.2, 61.9, 4}, Lamp{91, 60, 2}};

// Lamps behind the focus, each of the same light, before a grey ground.
Rgb lamps(const ApertureShape &shape, double coc, double scale) {
    Rgb result = test::colours(width, height, [](double, double, std::size_t) { return 0.05; });
    for (const Lamp &lamp : all_lamps) {
        const double radius = coc - scale * (lamp.depth - 7),
                     light = 150 / (area_of(shape) * radius * radius);
        const auto first = [&](double at) { return std::max(int(at - radius) - 1, 0); };
        const auto last = [&](double at, int size) { return std::min(int(at + radius) + 2, size); };
        for (int y = first(lamp.y); y < last(lamp.y, height); ++y)
            for (int x = first(lamp.x); x < last(lamp.x, width); ++x) {
                int inside = 0;
                for (int s = 0; s < 64; ++s)
                    inside += passes(shape, (x + (s % 8 + 0.5) / 8 - 0.5 - lamp.x) / radius,
                                     (lamp.y - y - (s / 8 + 0.5) / 8 + 0.5) / radius);
                for (std::vector<float> &plane : result.rgb)
                    plane[std::size_t(y * width + x)] += float(light * inside / 64);
            }
    }
    return result;
}

constexpr double scale = 0.8, coc = 6;

ShapeFit found(const ApertureShape &hidden, const KnownLens &known = {}) {
    Comparison pictures;
    pictures.colours = tone_mapped(lamps(hidden, coc, scale));
    pictures.plate = brightness(pictures.colours);
    pictures.usable = test::all_usable(pictures.plate.grid);
    pictures.near = 12, pictures.middle = 7, pictures.far = 2;
    const double factor = std::sqrt(area_of(hidden));
    return find_shape(pictures,
                      [](const ApertureShape &shape, double c, double s, bool) { return lamps(shape, c, s); },
                      known, {coc * factor, known.scale.value_or(scale * factor), 0});
}

TEST(ShapeSearch, TellsSixBladesFromADisc) {
    const ShapeFit six = found({.blades = 6, .rotation = 17});
    EXPECT_TRUE(six.is_told);
    EXPECT_EQ(six.shape.blades, 6);
    EXPECT_NEAR(six.shape.rotation, 17, 3);
    EXPECT_EQ(six.shape.squeeze, 1);
    const ShapeFit round = found({});
    EXPECT_TRUE(round.is_told);
    EXPECT_EQ(round.shape.blades, 0);
    EXPECT_EQ(round.shape.squeeze, 1);
}

TEST(ShapeSearch, TellsSqueeze) {
    const ShapeFit squeezed = found({.squeeze = 2});
    EXPECT_TRUE(squeezed.is_told);
    EXPECT_EQ(squeezed.shape.blades, 0);
    EXPECT_EQ(squeezed.shape.squeeze, 2);
    // The lamps lie at depths of 2 to 4.
    EXPECT_NEAR(squeezed.fit.guess.coc - squeezed.fit.guess.scale * (3 - 7), 6 + 0.8 * 4, 0.2);
}

TEST(ShapeSearch, TellsSqueezeAtAKnownRadius) {
    const ShapeFit squeezed = found({.squeeze = 2}, {.scale = scale});
    EXPECT_EQ(squeezed.shape.squeeze, 2);
    EXPECT_EQ(squeezed.fit.guess.scale, scale);
    EXPECT_NEAR(squeezed.fit.guess.coc, coc, 0.3);
}

TEST(ShapeSearch, AreasAreThoseOfPolygons) {
    EXPECT_EQ(area_of({}), 1);
    EXPECT_DOUBLE_EQ(area_of({.squeeze = 2}), 0.5);
    EXPECT_NEAR(area_of({.blades = 4}), 2 / std::numbers::pi, 1e-12); // a square of side sqrt(2)
}

} // namespace
} // namespace sparselens
