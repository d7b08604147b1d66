// The whole chain from a scene to the lens picture, at small size and default quality.
#include "deep/cluster.h"
#include "dof/lens/lens_gather.h"
#include "lab/tests/support/traced.h"
#include "lens/lens_points.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace sparselens {
namespace {

using namespace lab;

Image gather(const Ldi &ldi, const SceneCamera &scene, Quality quality = Quality::normal) {
    Progress silent;
    return lens_gather(ldi, scene.settings.lens, scene.settings.windows.data, {.quality = quality}, silent);
}

Ldi warped(const SceneCamera &scene, const std::vector<View> &views) {
    Progress silent;
    const ThinLens &lens = scene.settings.lens;
    const Ldi ldi = warp(views, {.focal_px = lens.focal_px, .radius = lens.radius}, silent);
    return cluster(ldi, {.scale = lens.radius * lens.focal_px, .tolerance = 0.25}, silent).ldi;
}

// A lamp of the scene "lamps": in a picture 320 pixels wide one pixel, at 640 two by two.
struct Lamp {
    Imath::V2d centre;
    double coc;
};

std::vector<Lamp> lamps_of(const ThinLens &lens, double pixels = 1) {
    constexpr double depths[] = {1.6, 2.4, 3.2, 9.6, 19.2, 38.4};
    std::vector<Lamp> lamps;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 6; ++column)
            lamps.push_back({pixels * Imath::V2d(32.5 + 51 * column, 35.5 + 54 * row),
                             circle_of_confusion(lens, depths[(column + 2 * row) % 6])});
    return lamps;
}

// visit(value less the background's, distance from the lamp's centre) for the pixels near it.
template <typename Visit>
void around(const Image &image, std::size_t channel, const Lamp &lamp, const Visit &visit) {
    const float background = image.at(channel, 0, 0);
    const int reach = int(std::abs(lamp.coc)) + 3;
    for (int y = int(lamp.centre.y) - reach; y <= int(lamp.centre.y) + reach; ++y)
        for (int x = int(lamp.centre.x) - reach; x <= int(lamp.centre.x) + reach; ++x)
            visit(double(image.at(channel, x, y)) - double(background),
                  (Imath::V2d(x + 0.5, y + 0.5) - lamp.centre).length());
}

// Views between whole pixels of parallax see a lamp as mixed pixels of partial coverage.
std::vector<View> nine_views(const SceneCamera &scene, int samples) {
    std::vector<View> views = scene.five_views(samples);
    for (const Imath::V2d &u : rim_lens_points(8))
        if (std::abs(u.x * u.y) > 0.1) views.push_back(scene.view(u, samples, std::uint32_t(views.size())));
    return views;
}

TEST(LensScenes, LampsKeepTheirEnergyInSmoothDiscs) {
    const SceneCamera scene("lamps", 320, 180);
    const Image image = gather(warped(scene, scene.five_views(4)), scene);
    for (const Lamp &lamp : lamps_of(scene.settings.lens)) {
        double energy = 0, inside = 0, squares = 0, beyond = 0;
        int pixels = 0;
        around(image, 0, lamp, [&](double value, double distance) {
            energy += value;
            if (distance > std::abs(lamp.coc) + 1.5) beyond = std::max(beyond, std::abs(value));
            if (distance > std::abs(lamp.coc) - 2) return;
            inside += value;
            squares += value * value;
            ++pixels;
        });
        const double mean = inside / pixels, deviation = std::sqrt(squares / pixels - mean * mean);
        EXPECT_NEAR(energy, 1000, 10) << lamp.coc;
        EXPECT_LT(deviation, 0.05 * mean) << lamp.coc;
        EXPECT_NEAR(mean, 1000 / (std::numbers::pi * lamp.coc * lamp.coc), 0.05 * mean) << lamp.coc;
        EXPECT_LT(beyond, 0.01) << lamp.coc;
    }
}

TEST(LensScenes, LampsOfPartialCoverageAreSmoothDiscsToo) {
    const SceneCamera scene("lamps", 640, 360);
    const Ldi ldi = warped(scene, nine_views(scene, 4));
    const std::size_t alpha = ldi.alpha(), red = find_channel(ldi.channels, "R");
    int partial = 0;
    for (std::size_t i = 0; i < ldi.samples(); ++i)
        partial += ldi.values[red][i] > 100 && ldi.values[alpha][i] < 1;
    ASSERT_GT(partial, 0); // otherwise this tests nothing
    const Image image = gather(ldi, scene);
    for (const Lamp &lamp : lamps_of(scene.settings.lens, 2)) {
        double inside = 0, squares = 0;
        int pixels = 0;
        around(image, 0, lamp, [&](double value, double distance) {
            if (distance > std::abs(lamp.coc) - 4) return;
            inside += value;
            squares += value * value;
            ++pixels;
        });
        const double mean = inside / pixels;
        EXPECT_LT(std::sqrt(squares / pixels - mean * mean), 0.05 * mean) << lamp.coc;
    }
}

// The part of the scene "macro" that the near relief fills.
Image relief(const Image &image) {
    const Imath::V2i size = image.windows.data.size() + Imath::V2i(1);
    return crop(image, {{size.x * 3 / 16, size.y / 5}, {size.x * 13 / 16, size.y * 4 / 5}});
}

double toned(const Image &image, int x, int y) {
    const double green = double(image.at(1, x, y));
    return std::pow(green / (1 + green), 1 / 2.2);
}

// The mean difference of columns from the mean of their neighbours.
std::map<int, double> roughness_of_columns(const Image &image) {
    const Imath::Box2i &box = image.windows.data;
    std::map<int, double> rough;
    for (int x = box.min.x + 1; x < box.max.x; ++x)
        for (int y = box.min.y; y <= box.max.y; ++y)
            rough[x] += std::abs(toned(image, x, y) - (toned(image, x - 1, y) + toned(image, x + 1, y)) / 2) /
                        double(box.max.y - box.min.y + 1);
    return rough;
}

struct Mean {
    double sum = 0, squares = 0;
    int count = 0;
    void add(double value) { sum += value, squares += value * value, ++count; }
    double mean() const { return sum / count; }
    double deviation() const { return std::sqrt(squares / count - mean() * mean()); }
};

// Lamps behind a steep relief do not shine through it at borders between tiles: the six columns there are as even as
// any six, within three standard errors of their mean. floors/floors.h covers the rest of the picture.
TEST(LensScenes, MacroReliefHasNoSeam) {
    const SceneCamera scene("macro", 256, 144);
    const Image image = relief(gather(warped(scene, scene.five_views(9)), scene, Quality::final));
    const std::map<int, double> rough = roughness_of_columns(image);
    Mean at_borders, elsewhere;
    for (const auto &[x, value] : rough) (x % 64 == 0 || x % 64 == 63 ? at_borders : elsewhere).add(value);
    EXPECT_EQ(at_borders.count, 6);
    EXPECT_LE(at_borders.mean(), elsewhere.mean() + 3 * elsewhere.deviation() / std::sqrt(at_borders.count));
}

} // namespace
} // namespace sparselens
