// The whole chain from a scene that moves to the picture of its shutter's moments.
#include "deep/cluster.h"
#include "dof/lens/lens_gather.h"
#include "lab/tests/support/traced.h"
#include "lab/tests/trace/small_scenes.h"
#include "shutter/shutter_mean.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace sparselens {
namespace {

using namespace lab;

// Five views at each moment, with noise of their own.
Image picture_of_moments(SceneCamera &scene, int moments, int samples, const LensGatherOptions &by = {}) {
    const ThinLens lens = scene.settings.lens;
    Progress silent;
    ShutterMean mean;
    for (int moment = 0; moment < moments; ++moment) {
        scene.settings.exposure = moment_of(moment, moments);
        scene.settings.seed = std::uint32_t(moment);
        scene.settings.scattered = moments > 1;
        const Ldi warped = warp(scene.five_views(samples / moments),
                                {.focal_px = lens.focal_px, .radius = lens.radius}, silent);
        const Ldi ldi =
            cluster(warped, {.scale = lens.radius * lens.focal_px, .tolerance = 0.25}, silent).ldi;
        LensGatherOptions options = by;
        options.share = {moment, moments};
        mean.add(lens_gather(ldi, lens, scene.settings.windows.data, options, silent),
                 std::vector<double>(std::size_t(scene.settings.windows.display_height()), 1.0),
                 moment == moments / 2);
    }
    return mean.take();
}

// A square lamp that crosses the frame before nothing: its disc has a radius of 9.6 pixels.
constexpr double side = 4, path = 24, radius = 9.6;
constexpr int width = 72, height = 32;

Scene moving_lamp() {
    const double z = 2.5, unit = z / width, half = side / 2 * unit;
    Scene scene;
    scene.sky_coverage = 0;
    scene.bodies = {{{facing_quad(-half, -half, half, half, z, white_light)}, {}, {}}};
    scene.bodies[0].motion.path = {{-path / 2 * unit, 0, 0}, {path / 2 * unit, 0, 0}};
    return scene;
}

// The mean over the lamp and the pixel at (x, y) from the middle, of the shares of its discs at all moments.
double discs(double x, double y, int moments) {
    constexpr int parts = 8;
    const auto at = [](int i, double length) { return ((i + 0.5) / parts - 0.5) * length; };
    double inside = 0;
    for (int m = 0; m < moments; ++m)
        for (int i = 0; i < parts * parts; ++i)
            for (int j = 0; j < parts * parts; ++j) {
                const double from = path * ((m + 0.5) / moments - 0.5);
                inside += std::hypot(x - from + at(i % parts, side) + at(j % parts, 1),
                                     y + at(i / parts, side) + at(j / parts, 1)) < radius;
            }
    return inside / (moments * std::pow(parts, 4)) * side * side / (std::numbers::pi * radius * radius);
}

// The error is at most that of as many random lens points, of which each pixel sees the lamp through a share.
TEST(Moments, ADiscThatMovesIsItsDiscAtEachMoment) {
    const RenderSettings settings = settings_of_size(width, height, radius * 5 / width);
    SceneCamera scene(moving_lamp(), settings.lens, width, height);
    constexpr int points = 4096;
    const double share = side * side / (std::numbers::pi * radius * radius), // 0.055
        standard_error = std::sqrt(share * (1 - share) / points);            // 0.0036
    for (const int moments : {1, 4}) {
        const Image image = picture_of_moments(scene, moments, 64, {.lens_samples = points});
        for (const std::size_t k : {0u, 3u}) {
            double squares = 0;
            int pixels = 0;
            for (int y = 0; y < height; y += 3)
                for (int x = 0; x < width; ++x, ++pixels) {
                    const double expected = discs(x + 0.5 - width / 2.0, y + 0.5 - height / 2.0, moments);
                    EXPECT_NEAR(image.at(k, x, y), expected, 4 * standard_error) << x << ' ' << y;
                    squares += std::pow(image.at(k, x, y) - expected, 2);
                }
            EXPECT_LT(std::sqrt(squares / pixels), standard_error) << moments << " moments, channel " << k;
        }
    }
}

} // namespace
} // namespace sparselens
