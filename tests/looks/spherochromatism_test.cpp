// Spherochromatism in closed form: the discs of a lamp in each colour, their light, and what 0 does.
#include "deep/flatten.h"
#include "dof/lens/lens_gather.h"
#include "lens/lamp_spread.h"
#include "looks/table.h"
#include "support/deep_scenes.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

LensLooks looks_of(double spherochromatism, double spherical = 0) {
    LookValues values;
    values.spherochromatism = spherochromatism;
    values.spherical = spherical;
    LensLooks looks;
    values.act({.lens = lens}, looks);
    return looks;
}

Image gather(const Ldi &ldi, const LensLooks &looks) {
    Progress silent;
    return lens_gather(ldi, lens, ldi.windows.data, {.looks = looks}, silent);
}

TEST(Spherochromatism, IsLessForRedAndMoreForBlue) {
    EXPECT_EQ(looks_of(0.25, 0.5).aperture.spherical, ByColour(0.25, 0.5, 0.75));
    EXPECT_EQ(looks_of(-0.25).aperture.spherical, ByColour(0.25, 0, -0.25));
    EXPECT_EQ(looks_of(0), LensLooks());
}

// The density of a disc at the distance r from its middle, relative to an even disc of the same light.
double density(double spherical, double coc, double r) {
    const double s = std::clamp(spherical, -1.0, 1.0) * (coc > 0 ? 1 : -1);
    return 1 + s * (2 * r * r / (coc * coc) - 1);
}

// The mean of r^2 over a pixel is that of its middle plus 1/6.
TEST(Spherochromatism, DrawsADiscInEachColour) {
    constexpr int size = 40;
    for (const double coc : {12.5, -12.5})
        for (const double spherical : {0.0, 0.6}) {
            const Lamp lamp{{20.2, 19.7}, coc};
            const LampSpread spread = spread_lamp(Aperture(looks_of(0.7, spherical).aperture), lamp,
                                                  {{0, 0}, Imath::V2i(size - 1)});
            std::array<double, 3> sums{};
            std::size_t i = 0;
            for (int y = spread.box.min.y; y <= spread.box.max.y; ++y)
                for (int x = spread.box.min.x; x <= spread.box.max.x; ++x, ++i) {
                    const Imath::V2d off = Imath::V2d(x + 0.5, y + 0.5) - lamp.centre;
                    for (std::size_t k = 0; k < 3; ++k) {
                        sums[k] += spread.colours[i][k];
                        if (off.length() > std::abs(coc) - 1) continue;
                        const double s = spherical + 0.7 * (double(k) - 1),
                                     r = std::sqrt(off.dot(off) + 1.0 / 6);
                        ASSERT_NEAR(spread.colours[i][k] * std::numbers::pi * coc * coc, density(s, coc, r),
                                    1e-3);
                    }
                }
            for (const double sum : sums) EXPECT_NEAR(sum, 1, 1e-6); // each colour keeps its light
        }
}

// One lamp of radiance 1000 in all colours.
Ldi lamp_alone(double coc) {
    return make_ldi(windows_of_size(48, 48), rgba_channels(), [&](int x, int y) {
        std::vector<Sample> samples;
        if (x == 24 && y == 24) samples.push_back({depth_of(lens, coc), {1000, 1000, 1000, 1}});
        return samples;
    });
}

TEST(Spherochromatism, GathersLampsWithColouredRimsAndTheirLight) {
    for (const double coc : {6.5, -15.5}) { // a disc small enough for cells of the lens, and a large one
        const Image image = gather(lamp_alone(coc), looks_of(0.8));
        std::array<double, 4> sums{};
        for (std::size_t k = 0; k < 4; ++k)
            for (const float v : image.plane(k)) sums[k] += double(v);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(sums[k], 1000, 1) << coc;
        const auto at = [&](std::size_t k, int x) { return double(image.at(k, x, 24)); };
        const int rim = 24 + int(std::abs(coc)) - 1;
        for (const int x : {24, rim})
            for (std::size_t k = 0; k < 3; ++k) {
                const double r = std::sqrt((x - 24) * (x - 24) + 1.0 / 6);
                const double even = 1000 / (std::numbers::pi * coc * coc);
                EXPECT_NEAR(at(k, x) / even, density(0.8 * (double(k) - 1), coc, r), 0.02)
                    << coc << ", " << x;
            }
        EXPECT_EQ(at(2, rim) > at(0, rim), coc > 0); // blue rims behind focus, red ones in front
    }
}

// A step of brightness has a blue and a red side, too. Surfaces of one brightness stay grey.
TEST(Spherochromatism, ColoursEdgesAndKeepsGreySurfacesGrey) {
    const auto step = [](int x, int) {
        return std::vector<Sample>{{10, {x < 24 ? 1 : 0.2f, x < 24 ? 1 : 0.2f, x < 24 ? 1 : 0.2f, 1}}};
    };
    const Image image = gather(make_ldi(windows_of_size(48, 48), rgba_channels(), step), looks_of(0.9));
    EXPECT_NEAR(image.at(0, 2, 24), 1, 1e-4);
    EXPECT_NEAR(image.at(2, 45, 24), 0.2, 1e-4);
    double coloured = 0;
    for (int x = 0; x < 48; ++x)
        coloured = std::max(coloured, double(std::abs(image.at(0, x, 24) - image.at(2, x, 24))));
    EXPECT_GT(coloured, 0.02);
}

TEST(Spherochromatism, OfZeroChangesNoBit) {
    const Ldi ldi = random_surfaces(windows_of_size(70, 40), lens, false, 5);
    EXPECT_EQ(gather(ldi, looks_of(0)).values, gather(ldi, {}).values);
    EXPECT_EQ(gather(ldi, looks_of(0, 0.4)).values, gather(ldi, {.aperture = {.spherical = 0.4}}).values);
    EXPECT_GT(largest_difference(gather(ldi, looks_of(0.5)), gather(ldi, {})), 0.01);
}

} // namespace
} // namespace sparselens
