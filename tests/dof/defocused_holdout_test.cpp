// A holdout that is out of focus too: the picture and the holdout's own share add up to the scene of both.
#include "deep/merge.h"
#include "deep/tidy.h"
#include "dof/gather_picture.h"
#include "dof/methods.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

Image gather(const Ldi &ldi, const GatherMethod &method, const Imath::Box2i &window) {
    Progress silent;
    GatherOptions options;
    options.lens.lens_samples = 64;
    return method.gather(ldi, lens, window, options, silent);
}

// One surface over the columns [begin, end).
Ldi card(const Windows &windows, double z, int begin, int end, const std::vector<float> &values) {
    return make_ldi(windows, rgba_channels(), [&](int x, int) {
        return x >= begin && x < end ? std::vector<Sample>{{z, values}} : std::vector<Sample>{};
    });
}

TEST(DefocusedHoldout, AndItsOwnShareAddUpToTheScene) {
    const Windows windows = windows_of_size(60, 12);
    const std::vector<float> wall_colour{0.5f, 0.25f, 0.125f, 1}, white{0.6f, 0.6f, 0.6f, 0.6f};
    const Ldi wall = card(windows, 20, 10, 60, wall_colour), front = card(windows, 3, 0, 30, white);
    const Ldi scene = tidy(deep_merge({wall, front}));
    for (const GatherMethod &method : gather_methods()) {
        const Image both = gather(scene, method, windows.data);
        const Image held = without_holdout(gather(with_holdout(wall, front), method, windows.data));
        // The front object is in front of everything, so nothing reduces its own share; it holds out only the wall.
        const Image own = without_holdout(gather(with_holdout(front, wall), method, windows.data));
        ASSERT_EQ(held.channels, wall.channels);
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t i = 0; i < windows.pixels(); ++i)
                ASSERT_NEAR(held.plane(k)[i] + own.plane(k)[i], both.plane(k)[i], 1e-5) << method.name << k;
    }
}

// A sharp holdout has an edge at one pixel; out of focus the edge is as wide as its blur.
TEST(DefocusedHoldout, HasTheBlurOfItsDepth) {
    const Windows windows = windows_of_size(60, 12);
    const Ldi wall = card(windows, 5, 0, 60, {1, 1, 1, 1}), front = card(windows, 3, 0, 30, {1, 1, 1, 1});
    const Image held =
        without_holdout(gather(with_holdout(wall, front), gather_methods().front(), windows.data));
    const float blur = float(-circle_of_confusion(lens, 3));
    EXPECT_NEAR(held.at(0, 30 - int(blur) - 2, 6), 0, 1e-6);
    EXPECT_NEAR(held.at(0, 30, 6) + held.at(0, 29, 6), 1, 0.06);
    EXPECT_NEAR(held.at(0, 30 + int(blur) + 2, 6), 1, 1e-6);
    for (int x = 0; x < 60; ++x) EXPECT_NEAR(held.at(3, x, 6), held.at(0, x, 6), 1e-6) << x;
}

} // namespace
} // namespace sparselens
