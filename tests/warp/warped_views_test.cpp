// Any views can be warped: in any order, with other windows, with other channels, and empty ones.
#include "base/error.h"
#include "support/scratch_folder.h"
#include "warp/warp_fixture.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace sparselens {
namespace {

using namespace warping;

TEST(WarpedViews, TheOrderOfRimViewsDoesNotMatter) {
    const Windows w = windows_of_size(40, 30);
    const auto views = random_views(w, 7);
    for (const WarpOptions &options : {averaging, keeping}) {
        const Ldi ldi = warped(views, options);
        auto shuffled = views;
        std::reverse(shuffled.begin() + 1, shuffled.end());
        expect_same_bits(warped(shuffled, options), ldi);
        std::rotate(shuffled.begin() + 1, shuffled.begin() + 3, shuffled.end());
        expect_same_bits(warped(shuffled, options), ldi);
    }
}

// Also if they have one position, as renders of one view with different noise.
TEST(WarpedViews, TheOrderOfViewsAtOnePointDoesNotMatter) {
    const Windows w = windows_of_size(40, 30);
    auto views = random_views(w, 7);
    for (View &view : views) view.position = {0.03, 0};
    views[0].position = {0, 0};
    for (const WarpOptions &options : {averaging, keeping}) {
        auto shuffled = views;
        std::reverse(shuffled.begin() + 1, shuffled.end());
        expect_same_bits(warped(shuffled, options), warped(views, options));
    }
}

TEST(WarpedViews, TheNumberOfThreadsDoesNotMatter) {
    const auto views = random_views(windows_of_size(40, 90), 5);
    const auto with_threads = [&](std::size_t threads, const WarpOptions &options) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return warped(views, options);
    };
    for (const WarpOptions &options : {averaging, keeping})
        expect_same_bits(with_threads(1, options), with_threads(4, options));
}

TEST(WarpedViews, DataWindowsMayDiffer) {
    const TwoPlanes scene = one_plane([](double x, double) { return float(x); });
    Windows whole = windows_of_size(40, 30), crop = whole;
    crop.data = Imath::Box2i({30, -5}, {60, 9});
    for (const auto &[centre, rim] : {std::pair(whole, crop), std::pair(crop, whole)}) {
        const std::vector<View> views{scene.view(centre, {0, 0}), scene.view(rim, {0.05, 0.02})};
        const Ldi kept = warped(views, keeping), ldi = warped(views);
        EXPECT_EQ(kept.windows, centre);
        EXPECT_EQ(ldi.windows.display, centre.display);
        double most_weight = 0;
        for_each_pixel(centre.data, [&](int x, int y) {
            ASSERT_EQ(pixel_at(kept, x, y).size(), 1u);
            ASSERT_EQ(pixel_at(ldi, x, y).size(), 1u); // one plane, whichever view saw it
            const TestSample s = pixel_at(ldi, x, y)[0];
            EXPECT_NEAR(s.colour, x + 0.5 + double(s.dx), 1e-4);
            most_weight = std::max(most_weight, double(s.weight));
        });
        EXPECT_EQ(most_weight, 2);
    }
}

TEST(WarpedViews, DisplayWindowsMayNot) {
    View centre = random_view(windows_of_size(8, 8), {0, 0}, 1),
         rim = random_view(windows_of_size(8, 9), {1, 0}, 2);
    centre.name = "centre.exr";
    rim.name = "rim.exr";
    EXPECT_EQ(what_of<Error>([&] {
                  warped({centre, rim});
              }),
              "rim.exr: its display window differs from that of the centre view (centre.exr)");
}

TEST(WarpedViews, ChannelsAreMatchedByName) {
    const Windows w = windows_of_size(4, 4);
    View centre = random_view(w, {0, 0}, 1), rim = centre;
    std::swap(rim.image.channels[0], rim.image.channels[3]); // A, G, B, R
    std::ranges::swap_ranges(rim.image.plane(0), rim.image.plane(3));
    rim.image.channels.push_back({"more"});
    rim.image.values.resize(5 * w.pixels());
    EXPECT_EQ(warped({centre, rim}).values, warped({centre, centre}).values);
    centre.image.channels[1].name = "albedo.G";
    rim.name = "rim.exr";
    EXPECT_EQ(what_of<Error>([&] {
                  warped({centre, rim});
              }),
              "rim.exr: has no channel albedo.G, which the centre view has");
}

TEST(WarpedViews, IdsAreNeverAveraged) {
    const Windows w = windows_of_size(30, 20);
    auto views = random_views(w, 5);
    std::set<float> ids;
    for (View &view : views) {
        view.image.channels.push_back({"id", PixelType::uint32});
        for (std::size_t pixel = 0; pixel < w.pixels(); ++pixel)
            view.image.values.push_back(float(ids.size() * 977 + 13));
        ids.insert(view.image.values.back());
    }
    const Ldi ldi = warped(views);
    for (const float id : ldi.values[4]) ASSERT_TRUE(ids.contains(id));
    const Windows &grown = ldi.windows;
    for_each_pixel(w.data, [&](int x, int y) {
        if (views[0].image.at(3, x, y) == 0) return;
        const std::size_t pixel = std::size_t(y - grown.data.min.y) * std::size_t(grown.width()) +
                                  std::size_t(x - grown.data.min.x);
        EXPECT_EQ(ldi.values[4][ldi.pixel(pixel).front()], 13); // from the centre view, which is in front
    });
}

TEST(WarpedViews, EmptyPixelsOfRimViewsAddNothing) {
    const Windows w = windows_of_size(12, 12);
    const View centre = random_view(w, {0, 0}, 1);
    const View empty = make_view(w, {0.05, 0}, [](int, int) { return ViewPixel{.z = 0.5f, .r = 9, .a = 0}; });
    expect_same_bits(warped({centre, empty}), warped({centre}));
}

// Nothing is in front of the centre view's surface, which is the background.
TEST(WarpedViews, AnEmptyCentreStaysEmpty) {
    const Windows w = windows_of_size(12, 12);
    const View nothing = make_view(w, {0, 0}, [](int, int) { return ViewPixel{.a = 0}; });
    const View rim = make_view(w, {0.05, 0}, [](int, int) { return ViewPixel{.z = inf, .r = 3}; });
    EXPECT_EQ(warped({nothing, rim}).samples(), 0u);
    EXPECT_EQ(warped({nothing, rim}, keeping).samples(), 0u);
}

// Averaging keeps pixels of rim views beside the centre view's picture, because a lens sees them too.
TEST(WarpedViews, WhatLiesBesideThePictureIsKept) {
    const TwoPlanes scene = one_plane([](double x, double) { return float(x); });
    const Windows w = windows_of_size(20, 10);
    const auto views = five_views(scene, w, radius);
    const Ldi ldi = warped(views);
    const int reach = int(std::floor(radius * focal_px / scene.front_z + 0.5));
    EXPECT_EQ(ldi.windows.data, Imath::Box2i({-reach, -reach}, {19 + reach, 9 + reach}));
    for_each_pixel({{-reach, 0}, {-1, 9}}, [&](int x, int y) {
        const TestPixel samples = pixel_at(ldi, x, y);
        ASSERT_LE(samples.size(), 1u);
        EXPECT_TRUE(x == -reach || samples.size() == 1); // the last column is only partly reached
        for (const TestSample &s : samples) EXPECT_NEAR(s.colour, x + 0.5 + double(s.dx), 1e-4);
    });
    EXPECT_EQ(warped(views, keeping).windows, w);
}

} // namespace
} // namespace sparselens
