// The part of the aperture that a second circle leaves open.
#include "base/image.h"
#include "lens/cat_eye.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sparselens {
namespace {

using Light = CatEye::Light;

Windows window(int width, int height) {
    Windows windows;
    windows.display = windows.data = {{0, 0}, {width - 1, height - 1}};
    return windows;
}

// The share of a circle of radius 1 inside another one whose middle is d away.
double lens_of_two_circles(double d) {
    return d >= 2 ? 0 : (2 * std::acos(d / 2) - d / 2 * std::sqrt(4 - d * d)) / std::numbers::pi;
}

TEST(CatEye, LeavesTheLensOfTwoCircles) {
    const Windows windows = window(80, 60); // half a diagonal is 50 pixels
    for (const double amount : {0.3, 1.0, 4.0}) {
        const LensLooks looks{.aperture = {.squeeze = 2}, .cat_eye = amount};
        const Aperture aperture(looks.aperture);
        const CatEye cat_eye(aperture, looks, picture_frame(windows, looks));
        const std::vector<double> shares = cat_eye.shares(Light::evenly, windows.data);
        for (std::size_t i = 0; i < shares.size(); ++i) {
            const Imath::V2d p = Imath::V2d(windows.pixel(i)) + Imath::V2d(0.5);
            const double expected = lens_of_two_circles(amount * (p - Imath::V2d(40, 30)).length() / 50);
            ASSERT_NEAR(cat_eye.share(Light::evenly, p), expected, 2e-4) << p;
            ASSERT_NEAR(shares[i], expected, 1e-3) << p;
        }
    }
}

// A lens that weights its rim more behind focus, by 1 + S (2 r^2 - 1), and less in front. The sum over the common area
// of both circles uses a million points of the square around the lens.
TEST(CatEye, LeavesOfARingWhatLiesWithinBothCircles) {
    constexpr double s = 0.9, d = 0.7;
    constexpr int n = 1000;
    double behind = 0, in_front = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double x = (i + 0.5) * 2 / n - 1, y = (j + 0.5) * 2 / n - 1, square = x * x + y * y;
            if (square > 1 || (x - d) * (x - d) + y * y > 1) continue;
            behind += (1 + s * (2 * square - 1)) * 4 / (n * n * std::numbers::pi); // 1 for the whole disc
            in_front += (1 - s * (2 * square - 1)) * 4 / (n * n * std::numbers::pi);
        }
    const LensLooks looks{.aperture = {.spherical = s}, .cat_eye = 1};
    const Aperture aperture(looks.aperture);
    const CatEye cat_eye(aperture, looks, picture_frame(window(80, 60), looks));
    const Imath::V2d p(40 + 50 * d, 30);
    EXPECT_NEAR(cat_eye.share(Light::behind, p), behind, 1e-3);
    EXPECT_NEAR(cat_eye.share(Light::in_front, p), in_front, 1e-3);
    EXPECT_GT(in_front - behind, 0.01); // otherwise the weights would not matter
}

TEST(CatEye, LeavesOfEachColourWhatItsOwnRimsSay) {
    const LensLooks coloured{.aperture = {.spherical = {-0.6, 0.2, 1}}, .cat_eye = 1};
    const Imath::V2d p(75, 30);
    for (const std::size_t colour : {0u, 1u, 2u}) {
        const LensLooks even{.aperture = {.spherical = coloured.aperture.spherical[colour]}, .cat_eye = 1};
        const Aperture aperture(coloured.aperture), alike(even.aperture);
        const CatEye cat_eye(aperture, coloured, picture_frame(window(80, 60), coloured)),
            other(alike, even, picture_frame(window(80, 60), even));
        for (const Light light : {Light::behind, Light::in_front}) {
            EXPECT_EQ(cat_eye.share(light, p, colour), other.share(light, p));
            EXPECT_EQ(cat_eye.shares(light, {{70, 30}, {75, 32}}, colour),
                      other.shares(light, {{70, 30}, {75, 32}}));
        }
    }
}

TEST(CatEye, ColumnsAreThePixelsThatSeeALensPoint) {
    const Windows windows = window(64, 48);
    const LensLooks looks{.aperture = {.squeeze = 1.5}, .cat_eye = 1.6};
    const Aperture aperture(looks.aperture);
    const CatEye cat_eye(aperture, looks, picture_frame(windows, looks));
    int cut = 0;
    for (const Imath::V2f &at : {Imath::V2f(0, 0), {0.5f, 0.3f}, {-0.6f, 0.1f}, {0.1f, -0.9f}, {-0.2f, 0.7f}})
        for (int y = 0; y < 48; ++y) {
            const CatEye::Columns columns = cat_eye.columns({at.x, at.y, 0, 0, 1}, 3, 50, y);
            for (int x = 0; x < 50; ++x) {
                const bool passes = cat_eye.passes({at.x, -at.y}, {x + 3.5, y + 0.5});
                ASSERT_EQ(x >= columns.begin && x < columns.end, passes) << at << x << ' ' << y;
                cut += passes ? 0 : 1;
            }
        }
    EXPECT_GT(cut, 1000);
}

TEST(CatEye, LeavesTheSameOfABoxAsOfItsPixels) {
    const Windows windows = window(32, 24);
    const auto grey =
        std::make_shared<AperturePicture>(AperturePicture{2, 2, {1, 1, 1, 3, 3, 3, 1, 1, 1, 1, 1, 1}});
    for (const ApertureShape &shape : {ApertureShape{.blades = 6, .rotation = 10}, ApertureShape{.blades = 3},
                                       ApertureShape{.blades = 5, .curvature = 0.5, .spherical = -0.8},
                                       ApertureShape{.spherical = 1}, ApertureShape{.picture = grey}}) {
        const LensLooks looks{.aperture = shape, .cat_eye = 1.3};
        const Aperture aperture(shape);
        const CatEye cat_eye(aperture, looks, picture_frame(windows, looks));
        for (const Light light : {Light::evenly, Light::behind, Light::in_front}) {
            const std::vector<double> shares = cat_eye.shares(light, windows.data);
            const double counted = shape.picture ? 5e-3 : 2e-3; // for pictures, points are counted
            for (std::size_t i = 0; i < shares.size(); ++i) {
                const Imath::V2d p = Imath::V2d(windows.pixel(i)) + Imath::V2d(0.5);
                ASSERT_NEAR(shares[i], cat_eye.share(light, p), counted) << p << shape.blades;
            }
        }
    }
}

} // namespace
} // namespace sparselens
