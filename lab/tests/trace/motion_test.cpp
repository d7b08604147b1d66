#include "lab/tests/trace/small_scenes.h"
#include "lab/trace/motion.h"
#include "lab/trace/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sparselens::lab {
namespace {

Progress silent;

TEST(Motion, TurnsAboutItsPivotAndFollowsItsPath) {
    const double quarter = std::numbers::pi / 2;
    const Motion motion{{{0, 0, 0}, {1, 0, 0}, {1, 4, 0}}, 2 * quarter, {2, 0, 5}, {0, 0, 1}};
    const auto near = [](const Imath::V3d &a, const Imath::V3d &b) { return (a - b).length() < 1e-12; };
    const Imath::V3d point(3, 0, 5);
    EXPECT_TRUE(near(Placement(motion, 0).point(point), {2, -1, 5})); // a quarter back
    EXPECT_TRUE(near(Placement(motion, 0.5).point(point), {4, 0, 5}));
    EXPECT_TRUE(near(Placement(motion, 1).point(point), {3, 5, 5}));
    EXPECT_TRUE(near(Placement(motion, 0.75).point({2, 0, 5}), {3, 2, 5}));
    EXPECT_TRUE(near(Placement(motion, 1).direction({1, 0, 0}), {0, 1, 0}));
    for (const double time : {0.0, 0.3, 1.0}) {
        const Placement placement(motion, time);
        EXPECT_TRUE(near(placement.point_at_rest(placement.point({1, 2, 3})), {1, 2, 3}));
        EXPECT_TRUE(near(placement.direction_at_rest(placement.direction({1, 2, 3})), {1, 2, 3}));
    }
}

TEST(Motion, MomentsAreTheMiddlesOfEqualParts) {
    EXPECT_EQ(moment_of(0, 1).opens, 0.5);
    EXPECT_EQ(moment_of(0, 4).opens, 0.125);
    EXPECT_EQ(moment_of(3, 4).closes, 0.875);
    EXPECT_TRUE(moment_of(2, 8).instant());
}

// With the shutter open, a scene that stands still has the pictures of an instant, bit for bit.
TEST(Motion, AStillSceneIsTheStill) {
    RenderSettings still = settings_of_size(64, 36);
    still.light = Light::area;
    RenderSettings open = still;
    open.exposure = whole_shutter;
    for (const char *name : {"fence", "mirror", "mist"}) {
        const Tracer tracer(build_scene(name));
        EXPECT_EQ(render_view(tracer, open, {1, 0}, 5, 1, silent).values,
                  render_view(tracer, still, {1, 0}, 5, 1, silent).values)
            << name;
        EXPECT_EQ(render_reference(tracer, open, 6, silent).values,
                  render_reference(tracer, still, 6, silent).values)
            << name;
    }
}

// A square lamp, four pixels wide, before nothing: its disc has a radius of 9.6 pixels, and its path `length` pixels.
constexpr double lamp_side = 4, lamp_z = 2.5;

Scene moving_lamp(const RenderSettings &settings, double length) {
    const double unit = lamp_z / settings.lens.focal_px, half = lamp_side / 2 * unit;
    Scene scene;
    scene.sky_coverage = 0;
    scene.bodies = {{{facing_quad(-half, -half, half, half, lamp_z, white_light)}, {}, {}}};
    scene.bodies[0].motion.path = {{-length / 2 * unit, 0, 0}, {length / 2 * unit, 0, 0}};
    return scene;
}

// The share of a path from -length / 2 to length / 2 on which a disc of radius c covers (x, y), over the disc's area.
double streak(double x, double y, double c, double length) {
    if (std::abs(y) >= c) return 0;
    const double half = std::sqrt(c * c - y * y);
    const double from = std::max(x - half, -length / 2), to = std::min(x + half, length / 2);
    return std::max(0.0, to - from) / length / (std::numbers::pi * c * c);
}

// The same for the square lamp, averaged over a pixel.
double streak_of_lamp(double x, double y, double c, double length) {
    constexpr int parts = 8;
    const auto at = [](int i, double side) { return ((i + 0.5) / parts - 0.5) * side; };
    double sum = 0;
    for (int i = 0; i < parts * parts; ++i)
        for (int j = 0; j < parts * parts; ++j)
            sum += streak(x + at(i % parts, lamp_side) + at(j % parts, 1),
                          y + at(i / parts, lamp_side) + at(j / parts, 1), c, length);
    return sum * lamp_side * lamp_side / (parts * parts) / (parts * parts);
}

// The left half of some rows above the middle. The standard error of so many random rays is at most 0.0018.
void expect_streak(const Scene &scene, RenderSettings settings, double length) {
    const double c = std::abs(circle_of_confusion(settings.lens, lamp_z));
    EXPECT_NEAR(c, 9.6, 1e-9);
    settings.exposure = whole_shutter;
    settings.windows.data = {{0, 5}, {31, 12}};
    const Image image = render_reference(Tracer(scene), settings, 16384, silent);
    for (int y = 5; y <= 12; ++y)
        for (int x = 0; x < 32; ++x) {
            const double expected = streak_of_lamp(x + 0.5 - 32, y + 0.5 - 16, c, length);
            for (const std::size_t channel : {0u, 3u})
                EXPECT_NEAR(image.at(channel, x, y), expected, 0.004) << x << ' ' << y; // at most 0.055
        }
}

TEST(Motion, ADiscThatMovesIsItsDiscConvolvedWithItsPath) {
    RenderSettings settings = settings_of_size(64, 32, 0.75);
    const Scene scene = moving_lamp(settings, 20);
    expect_streak(scene, settings, 20);
    settings.looks.aperture.squeeze = 1.0000001; // rays of looks know the time too
    expect_streak(scene, settings, 20);
}

TEST(Motion, ACameraThatMovesStreaksTheSame) {
    RenderSettings settings = settings_of_size(64, 32, 0.75);
    Scene scene = moving_lamp(settings, 20);
    settings.camera.path = {scene.bodies[0].motion.path[1], scene.bodies[0].motion.path[0]};
    scene.bodies[0].motion = {};
    expect_streak(scene, settings, 20);
}

// The middle of a bar, in each row, is where the bar is in the middle of the row's exposure.
TEST(Motion, ARollingShutterSlantsABarThatMoves) {
    RenderSettings settings = settings_of_size(64, 32);
    settings.lens.radius = 0;
    settings.exposure = whole_shutter;
    settings.rolling = 0.125;
    const double unit = lamp_z / 64, length = 20;
    Scene scene;
    scene.sky_coverage = 0;
    scene.bodies = {{{facing_quad(-2 * unit, -100, 2 * unit, 100, lamp_z, white_light)}, {}, {}}};
    scene.bodies[0].motion.path = {{-length / 2 * unit, 0, 0}, {length / 2 * unit, 0, 0}};
    const Tracer tracer(scene);
    for (const Image &image : {render_view(tracer, settings, {0, 0}, 256, 1, silent),
                               render_reference(tracer, settings, 256, silent)})
        for (int y = 0; y < 32; ++y) {
            const double time = (y + 0.5) / 32 * (1 - 0.125) + 0.125 / 2;
            double sum = 0, moment = 0;
            for (int x = 0; x < 64; ++x) {
                sum += double(image.at(3, x, y));
                moment += double(image.at(3, x, y)) * (x + 0.5);
            }
            EXPECT_NEAR(sum, 4, 0.05) << y;
            EXPECT_NEAR(moment / sum, 32 + length * (time - 0.5), 0.05) << y;
        }
}

// Views with motion blur have the colours of all times, and the depth of one.
TEST(Motion, DepthsAreThoseOfTheMiddle) {
    RenderSettings settings = settings_of_size(64, 32);
    const Tracer tracer(moving_lamp(settings, 20));
    const Image still = render_view(tracer, settings, {0, 0}, 16, 1, silent);
    settings.exposure = whole_shutter;
    const Image blurred = render_view(tracer, settings, {0, 0}, 16, 1, silent);
    EXPECT_TRUE(std::ranges::equal(still.plane(4), blurred.plane(4)));
    EXPECT_EQ(still.at(3, 24, 16), 0);
    EXPECT_NEAR(blurred.at(3, 24, 16), lamp_side / 20, 0.07); // one of 16 times
    settings.exposure = moment_of(0, 4);
    EXPECT_EQ(render_view(tracer, settings, {0, 0}, 16, 1, silent).at(3, 24, 16), 1);
}

} // namespace
} // namespace sparselens::lab
