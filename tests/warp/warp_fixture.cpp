#include "warp/warp_fixture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sparselens::warping {

Ldi warped(const std::vector<View> &views, const WarpOptions &options) {
    Progress silent;
    return warp(views, options, silent);
}

void expect_same_bits(const Ldi &a, const Ldi &b) {
    EXPECT_EQ(a.windows, b.windows);
    EXPECT_EQ(a.begin, b.begin);
    EXPECT_EQ(a.z, b.z);
    EXPECT_EQ(a.dx, b.dx);
    EXPECT_EQ(a.dy, b.dy);
    EXPECT_EQ(a.weight, b.weight);
    EXPECT_EQ(a.image_z, b.image_z);
    EXPECT_EQ(a.solid, b.solid);
    EXPECT_EQ(a.values, b.values);
}

TestPixel pixel_at(const Ldi &ldi, int x, int y) {
    const Windows &w = ldi.windows;
    return samples_of(ldi,
                      std::size_t(y - w.data.min.y) * std::size_t(w.width()) + std::size_t(x - w.data.min.x));
}

TwoPlanes fence() {
    TwoPlanes scene;
    scene.front_covers = [](double x, double) { return std::fmod(x + 1000, 16) < 6; };
    return scene;
}

TwoPlanes one_plane(const std::function<float(double, double)> &red) {
    TwoPlanes scene;
    scene.front_z = 2.2;
    scene.front_covers = [](double, double) { return true; };
    scene.front_red = red;
    return scene;
}

std::vector<View> random_views(const Windows &windows, int count) {
    std::vector<View> views;
    for (int i = 0; i < count; ++i) {
        const double angle = 0.7 * i;
        const Imath::V2d rim = radius * Imath::V2d(std::cos(angle), std::sin(angle));
        views.push_back(random_view(windows, i == 0 ? Imath::V2d(0, 0) : rim, std::uint32_t(i + 1)));
    }
    return views;
}

} // namespace sparselens::warping
