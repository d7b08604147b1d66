#include "dof/facets/facets.h"
#include "dof/lens/lens_gather.h"
#include "lens/lens_samples.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.625, .focal_px = 640, .focus = 5}; // R F / focus = 80 px

// Channels Y and A; `depth`: disparity, pixels.
Ldi surface(int width, int height, const std::function<double(int x, int y)> &depth, double alpha = 1) {
    return make_ldi(windows_of_size(width, height), {{"Y"}, {"A"}}, [&](int x, int y) {
        return std::vector<Sample>{{lens.radius * lens.focal_px / depth(x, y), {0, float(alpha)}}};
    });
}

std::size_t facets_of(const Ldi &ldi) {
    std::size_t count = 0;
    for (const auto &block : find_facets(ldi, lens, 1).blocks) count += block.size();
    return count;
}
// A row of depths, three pixels high: the two triangles between four neighbours contain one link of the row, twice.
std::size_t steep_links(const std::vector<double> &depths) {
    return facets_of(surface(int(depths.size()), 3, [&](int x, int) { return depths[std::size_t(x)]; })) / 4;
}

TEST(Facets, FlatSurfacesHaveNone) {
    EXPECT_EQ(facets_of(surface(20, 20, [](int, int) { return 30; })), 0u);
    EXPECT_EQ(facets_of(surface(20, 20, [](int x, int y) { return 30 + 0.1 * x - 0.1 * y; })), 0u);
}

TEST(Facets, ATiltedPlaneHasTwoBetweenFourPixels) {
    EXPECT_EQ(facets_of(surface(20, 11, [](int x, int y) { return 60 - 1.5 * x + y; })), 2u * 19 * 10);
    EXPECT_EQ(facets_of(surface(20, 11, [](int x, int) { return 10 + 3 * x; })), 2u * 19 * 10);
}

TEST(Facets, NoneOfPartialCoverage) {
    EXPECT_EQ(facets_of(surface(
                  20, 11, [](int x, int) { return 10 + 3 * x; }, 0.5)),
              0u);
}

TEST(Facets, SilhouettesAreNoSurface) {
    EXPECT_EQ(steep_links({9, 9, 9, 9, 30, 30, 30, 30}), 0u);
    EXPECT_EQ(steep_links({9, 9.1, 9.2, 9.3, 30, 30.1, 30.2, 30.3}), 0u);
    EXPECT_EQ(steep_links({9, 9, 9, 20, 30, 30, 30}), 0u); // a mixed-depth pixel between them
    EXPECT_EQ(steep_links({30, 9, 30, 9, 30, 9, 30}), 0u);
    EXPECT_EQ(steep_links({10, 12, 14, 16, 40, 42, 44, 46}), 6u); // two slopes, one behind the other
}

// The steps from layer to layer would make a slope, but each layer goes on.
TEST(Facets, LayersBehindEachOtherAreNoSlope) {
    EXPECT_EQ(facets_of(make_ldi(windows_of_size(20, 11), {{"Y"}, {"A"}},
                                 [](int x, int) {
                                     std::vector<Sample> samples;
                                     for (const double depth : {90, 60, 30, 5})
                                         if (x < 10 || depth < 90)
                                             samples.push_back({lens.radius * lens.focal_px / depth, {0, 1}});
                                     return samples;
                                 })),
              0u);
}

TEST(Facets, SlopesGoOnToWhereTheyEnd) {
    EXPECT_EQ(steep_links({9, 9, 9, 11, 13, 15, 15, 15}), 3u);
    EXPECT_EQ(steep_links({9, 9, 9, 10, 12, 15, 19, 19}), 4u); // increasingly steep
    EXPECT_EQ(steep_links({10, 12, 14, 16, 14, 12, 10}), 6u);  // a ridge
}

// A dark plane of 3 pixels of CoC per pixel before a bright ground: the light of the ground that leaks through.
struct Tilted {
    static constexpr int width = 40, height = 200, middle = 20;
    static constexpr float plane = 0.25f; // its light
    static double coc(int x) { return 3 * (x - middle); }
    // Whether a lens point sees the plane there; otherwise it looks past its ends.
    static bool covered(double x, double u) {
        const auto seen = [&](int column) { return column + 0.5 + coc(column) * u; };
        const auto [left, right] = std::minmax({seen(0), seen(width - 1)});
        return x > left - 0.5 && x < right + 0.5;
    }
    static Ldi ldi(const std::vector<Channel> &channels, float ground, float lamp) {
        return make_ldi(windows_of_size(width, height), channels, [&](int x, int y) {
            const float light = x == middle && y == height / 2 ? ground + lamp : ground;
            std::vector<float> dark(channels.size(), plane), bright(channels.size(), light);
            dark.back() = bright.back() = 1;
            return std::vector<Sample>{{depth_of(lens, coc(x)), dark}, {depth_of(lens, 79), bright}};
        });
    }
};

TEST(Facets, NoLightPassesASteepSurface) {
    Progress silent;
    const Ldi ldi = Tilted::ldi({{"Y"}, {"A"}}, 1, 0);
    const Image image = lens_gather(ldi, lens, ldi.windows.data, {.lens_samples = 256}, silent);
    const auto points = disc_lens_samples(256, 1);
    for (int y = 61; y < Tilted::height - 61; ++y) // beyond, the plane is seen past its upper and lower ends
        for (int x = 10; x < 30; ++x) {
            double past = 0, total = 0;
            for (const LensSample &p : points) {
                total += double(p.weight);
                if (!Tilted::covered(x + 0.5 - double(p.pixel_x), double(p.x))) past += double(p.weight);
            }
            const double light = double(image.at(0, x, y)), dark = double(Tilted::plane);
            ASSERT_GE(light, dark - 1e-5) << x << ' ' << y;
            ASSERT_LE(light, dark + (1 - dark) * past / total + 1e-5) << x << ' ' << y;
        }
}

TEST(Facets, LightIsKeptWhereNothingIsBehind) {
    Progress silent;
    const Ldi ldi = make_ldi(windows_of_size(100, 80), {{"Y"}, {"A"}}, [&](int x, int y) {
        return std::vector<Sample>{{depth_of(lens, 0.9 * (x - 50) - 0.7 * (y - 40)), {0.25f, 1}}};
    });
    const Image image = lens_gather(ldi, lens, ldi.windows.data, {}, silent);
    for (const float value : image.plane(0)) ASSERT_NEAR(value, 0.25, 1e-5);
    for (const float alpha : image.plane(1)) ASSERT_NEAR(alpha, 1, 1e-5);
}

} // namespace
} // namespace sparselens
