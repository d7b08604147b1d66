// Opaque parts of the views pass no light in the LDI or through a lens; other parts do.
#include "deep/flatten.h"
#include "dof/methods.h"
#include "lab/reference/lens_gather_reference.h"
#include "lens/lens_samples.h"
#include "warp/warp_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace sparselens {
namespace {

using namespace warping;

// A view of two planes with pixels that mix them, each with the depth of its middle: 4x4 points per pixel. `hollow`:
// nothing is behind the front plane.
View antialiased(const TwoPlanes &planes, const Windows &windows, const Imath::V2d &position, bool hollow) {
    constexpr int n = 4;
    TwoPlanes fine = planes;
    fine.focal_px *= n;
    const Windows fine_windows = windows_of_size(n * windows.width(), n * windows.height());
    fine.front_covers = [&](double x, double y) { return planes.front_covers(x / n, y / n); };
    fine.front_red = [&](double x, double y) { return planes.front_red(x / n, y / n); };
    fine.back_green = [&](double x, double y) { return planes.back_green(x / n, y / n); };
    const View points = fine.view(fine_windows, position);
    return make_view(windows, position, [&](int x, int y) {
        ViewPixel pixel{.z = hollow ? float(planes.front_z) : 0, .a = 0};
        for (int i = 0; i < n * n; ++i) {
            const std::size_t at = fine_windows.index(Imath::V2i(n * x + i % n, n * y + i / n));
            const bool front = points.z[at] == float(planes.front_z);
            if (i == n * n / 2 + n / 2 && !hollow) pixel.z = points.z[at];
            if (hollow && !front) continue;
            pixel.r += points.image.plane(0)[at] / (n * n);
            pixel.g += points.image.plane(1)[at] / (n * n);
            pixel.a += 1.0f / (n * n);
        }
        return pixel;
    });
}

std::vector<View> antialiased_views(const TwoPlanes &planes, int count, bool hollow = false) {
    std::vector<View> views;
    for (int i = 0; i < count; ++i) {
        const double angle = 0.7 * i;
        const Imath::V2d rim = radius * Imath::V2d(std::cos(angle), std::sin(angle));
        views.push_back(
            antialiased(planes, windows_of_size(48, 32), i == 0 ? Imath::V2d(0, 0) : rim, hollow));
    }
    return views;
}

// Blobs that cover about half of the picture, with edges in all directions.
TwoPlanes blobs(double size) {
    TwoPlanes planes;
    planes.front_covers = [size](double x, double y) {
        return std::sin(x / size) + std::sin(y / size * 1.3 + std::cos(x / size / 2)) > 0.2;
    };
    planes.back_green = [](double x, double y) { return float(0.5 + 0.2 * std::sin(x) * std::sin(y)); };
    return planes;
}

std::vector<View> opaque_at_random(const Windows &windows) {
    std::vector<View> views = random_views(windows, 5);
    for (View &view : views)
        for (float &alpha : view.image.plane(3)) alpha = 1;
    return views;
}

WarpOptions splitting() {
    WarpOptions options = averaging;
    options.split_silhouettes = true;
    return options;
}

// Inside the frame; beyond it pixels are opaque too, or unseen.
void expect_opaque(const std::vector<View> &views) {
    const Ldi ldi = warped(views, splitting());
    const Image flat = flatten(ldi);
    for (std::size_t i = 0; i < flat.windows.pixels(); ++i) {
        const float alpha = flat.plane(3)[i];
        const bool seen = flat.windows.display.intersects(flat.windows.pixel(i)) || alpha > 1.0f / 2048;
        ASSERT_NEAR(alpha, seen, 1.0 / 2048) << "pixel " << i;
    }
    Progress silent;
    const Imath::Box2i &frame = ldi.windows.display;
    for (const double focus : {1.0, 2.5, 10.0}) {
        const ThinLens lens{.radius = radius, .focal_px = focal_px, .focus = focus};
        const auto expect_whole = [&](const Image &image, const char *what) {
            for (const float alpha : image.plane(3))
                ASSERT_NEAR(alpha, 1, 1e-3) << what << ", focus " << focus;
        };
        for (const Quality quality : {Quality::draft, Quality::normal})
            expect_whole(lens_gather(ldi, lens, frame, {.quality = quality}, silent), "lens");
    }
    const ThinLens lens{.radius = radius, .focal_px = focal_px, .focus = 2.5};
    const ReferencePicture slow = lens_gather_reference(ldi, lens, frame, disc_lens_samples(3, 1));
    for (int y = frame.min.y; y <= frame.max.y; ++y)
        for (int x = frame.min.x; x <= frame.max.x; ++x)
            ASSERT_NEAR(double(slow.at(3, x, y).value), 1, 1e-3) << x << ", " << y;
}

TEST(OpaquePictures, OpaqueViewsMakeAnOpaquePicture) {
    for (const double size : {1.5, 3.0, 7.0}) expect_opaque(antialiased_views(blobs(size), 5));
    expect_opaque(opaque_at_random(windows_of_size(24, 16)));
}

// A disc before nothing covers its area, and its edge is soft.
TEST(OpaquePictures, AnElementOverNothingKeepsItsEdges) {
    TwoPlanes disc;
    disc.front_covers = [](double x, double y) { return std::hypot(x - 24, y - 16) < 10; };
    const std::vector<View> views = antialiased_views(disc, 5, true);
    const Image flat = flatten(warped(views, splitting()));
    const auto area = [](std::span<const float> alpha) {
        return std::accumulate(alpha.begin(), alpha.end(), 0.0);
    };
    EXPECT_NEAR(area(views[0].image.plane(3)), 100 * M_PI, 2);
    EXPECT_NEAR(area(flat.plane(3)), 100 * M_PI, 6);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 48; ++x) {
            const float of_view = views[0].image.at(3, x, y);
            if (of_view < 0.1f || of_view > 0.9f) continue;
            EXPECT_LT(flat.at(3, x, y), 0.97f) << x << ", " << y;
        }
}

} // namespace
} // namespace sparselens
