#include "deep/view_samples.h"
#include "support/views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace sparselens {
namespace {

View some_view(std::uint32_t seed) {
    View view = random_view({Imath::Box2i({0, 0}, {29, 19}), Imath::Box2i({-3, 2}, {71, 30})}, {1, 2}, seed);
    for (float &red : view.image.plane(0)) red = std::round(red * 64) / 64; // a half
    view.framing.zoom = 1.5;
    return view;
}

TEST(PackedView, IsTheViewAgain) {
    const View view = some_view(7);
    const PackedView taken{View(view)}, referring(view);
    for (const PackedView *packed : {&taken, &referring}) {
        const View again = unpacked(*packed);
        EXPECT_EQ(again.name, view.name);
        EXPECT_EQ(again.image.windows, view.image.windows);
        EXPECT_EQ(again.image.channels, view.image.channels);
        EXPECT_EQ(again.image.values, view.image.values);
        EXPECT_EQ(again.z, view.z);
        EXPECT_EQ(again.position, view.position);
        EXPECT_EQ(again.framing, view.framing);
    }
    EXPECT_TRUE((taken.samples <=> referring.samples) == 0);
}

TEST(PackedView, ViewsAreOrderedByDepthsThenByValues) {
    const View view = some_view(7);
    View farther = view, brighter = view;
    farther.z.back() += 1;
    brighter.image.values.back() = 2;
    const PackedView own(view), far(farther), bright(brighter);
    EXPECT_TRUE(own.samples < far.samples && far.samples > own.samples);
    EXPECT_TRUE(own.samples < bright.samples && bright.samples < far.samples);
}

TEST(PackedView, WhatLiesBehindTheCentreShowsNothing) {
    View view = make_view(windows_of_size(3, 1), {0, 0}, [](int x, int) {
        return ViewPixel{.z = x == 2 ? std::numeric_limits<float>::infinity() : float(x + 1)};
    });
    std::vector<PackedView> views;
    views.emplace_back(view);
    views[0].samples.move_back(-1.5);
    EXPECT_EQ(views[0].samples.as_ldi().z,
              (std::vector<float>{0.5f, std::numeric_limits<float>::infinity()}));
    EXPECT_EQ(view.z[0], 1) << "the view is not its own";
}

TEST(PackedView, OfChannelsThoseAreKeptThatAreAskedFor) {
    const View view = some_view(3);
    PackedView packed{View(view)};
    const std::vector<Channel> kept{{"A"}, {"G"}};
    packed.samples.keep_channels(kept);
    EXPECT_EQ(packed.samples.as_ldi().values, ViewSamples(view, kept).as_ldi().values);
    EXPECT_EQ(packed.samples.channels, kept);
}

} // namespace
} // namespace sparselens
