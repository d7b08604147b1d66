// The samples of a warp: from which views they come, and where they are.
#include "deep/flatten.h"
#include "deep/view_samples.h"
#include "support/order.h"
#include "warp/coverage.h"
#include "warp/reprojected_views.h"
#include "warp/warp_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace sparselens {
namespace {

using namespace warping;

TEST(Warp, OneViewIsItsOwnLdi) {
    const Windows w{Imath::Box2i({0, 0}, {19, 9}), Imath::Box2i({-2, 3}, {12, 30})};
    const View view = random_view(w, {0, 0}, 1);
    for (const WarpOptions &options : {averaging, keeping}) {
        const Ldi ldi = warped({view}, options);
        EXPECT_EQ(ldi.windows, w);
        EXPECT_EQ(ldi.channels, view.image.channels);
        for (std::size_t pixel = 0; pixel < w.pixels(); ++pixel) {
            const TestPixel samples = samples_of(ldi, pixel);
            ASSERT_EQ(samples.size(), view.image.plane(3)[pixel] == 0 ? 0u : 1u);
            if (samples.empty()) continue;
            EXPECT_EQ(samples[0].z, view.z[pixel]);
            EXPECT_EQ(samples[0].colour, view.image.plane(0)[pixel]);
            EXPECT_EQ(samples[0].weight, 1);
            EXPECT_EQ(samples[0].dx, 0);
            EXPECT_EQ(samples[0].dy, 0);
        }
    }
}

TEST(Warp, TheCameraSaysHowManyPixelsBecomeOne) {
    const std::vector<View> views{random_view(windows_of_size(8, 4), {0, 0}, 1)};
    Camera camera;
    EXPECT_EQ(with_lens({}, camera, views).across, 1);
    camera.supersample = 4;
    EXPECT_EQ(with_lens({}, camera, views).across, 4);
}

TEST(Warp, OnePixel) {
    const auto samples_at = [](float z, const WarpOptions &options) {
        TwoPlanes scene;
        scene.back_z = double(z);
        return pixel_at(warped(five_views(scene, windows_of_size(1, 1), radius), options), 0, 0);
    };
    EXPECT_EQ(samples_at(1, averaging).size(), 1u); // the others fall elsewhere
    EXPECT_EQ(samples_at(1, averaging)[0].weight, 1);
    EXPECT_EQ(samples_at(1000, averaging)[0].weight, 5);
    for (const float z : {1.0f, 1000.0f, inf}) {
        EXPECT_EQ(samples_at(z, keeping).size(), 1u);
        EXPECT_FLOAT_EQ(samples_at(z, averaging)[0].z, z);
    }
}

TEST(Warp, IdenticalViewsChangeNothing) {
    const View view = random_view(windows_of_size(33, 21), {0, 0}, 5);
    const Ldi one = warped({view}), five = warped({view, view, view, view, view});
    EXPECT_EQ(one.begin, five.begin);
    EXPECT_EQ(one.values, five.values);
    EXPECT_EQ(five.weight, std::vector<float>(five.samples(), 5));
    for (std::size_t i = 0; i < one.samples(); ++i) EXPECT_FLOAT_EQ(one.z[i], five.z[i]);
}

TEST(Warp, KeepLeavesTheCentreViewAsItIs) {
    const Windows w = windows_of_size(40, 33);
    for (const auto &views : {random_views(w, 6), five_views(fence(), w, radius)}) {
        const Ldi ldi = warped(views, keeping);
        const Image &centre = views[0].image;
        for (std::size_t pixel = 0; pixel < w.pixels(); ++pixel) {
            const TestPixel samples = samples_of(ldi, pixel);
            if (centre.plane(3)[pixel] == 0) {
                EXPECT_TRUE(samples.empty()); // nothing is added in front of nothing
                continue;
            }
            ASSERT_FALSE(samples.empty());
            EXPECT_EQ(samples[0].z, views[0].z[pixel]); // so nothing is before it
            EXPECT_EQ(samples[0].colour, centre.plane(0)[pixel]);
            EXPECT_EQ(samples[0].alpha, centre.plane(3)[pixel]);
            EXPECT_EQ(samples[0].weight, 1);
        }
        const Image flat = flatten(ldi);
        for (std::size_t pixel = 0; pixel < w.pixels(); ++pixel)
            for (std::size_t k = 0; k < 4; ++k)
                EXPECT_TRUE(centre.plane(3)[pixel] != 1 || flat.plane(k)[pixel] == centre.plane(k)[pixel]);
    }
}

// For any views, z ascends strictly, so there is at most one sample at infinity.
TEST(Warp, SamplesAreTidy) {
    const Windows w = windows_of_size(50, 40);
    for (const WarpOptions &options : {averaging, keeping}) {
        const Ldi ldi = warped(random_views(w, 9), options);
        EXPECT_GT(ldi.samples(), w.pixels());
        const Order order = order_of(ldi);
        EXPECT_TRUE(order.sorted && order.apart);
        EXPECT_TRUE(std::ranges::all_of(ldi.values[3], [](float alpha) { return alpha > 0; }));
        EXPECT_TRUE(std::ranges::all_of(ldi.weight, [](float weight) { return weight > 0; }));
        for (const auto *offsets : {&ldi.dx, &ldi.dy})
            EXPECT_TRUE(std::ranges::all_of(*offsets, [](float d) { return std::abs(d) <= 0.5f; }));
    }
}

TEST(Warp, ViewsThatAreTakenGiveTheSameLdi) {
    const Windows w = windows_of_size(40, 30);
    for (const WarpOptions &options : {averaging, keeping}) {
        std::vector<View> views = random_views(w, 6);
        const Ldi seen = warped(views, options);
        Progress silent;
        expect_same_bits(warp(std::move(views), options, silent), seen);
    }
}

struct Witness {
    double depth;     // disparity
    float colour;     // not premultiplied
    Imath::V2d place; // within its pixel, 0..1
};

// The view pixels that land in a pixel of the centre view.
class Witnesses {
public:
    explicit Witnesses(const std::vector<View> &views) {
        for (const View &view : views) {
            const ViewSamples of_view(view, view.image.channels);
            std::vector<ReprojectedSample> samples;
            Reprojection(of_view, {view.position, focal_px, of_view.windows})
                .append_rows(-1000, 1000, samples);
            for (const ReprojectedSample &s : samples)
                landed_[{s.x, s.y}].push_back({focal_px * radius * double(s.inverse_z),
                                               of_view.value(0, s.source) / of_view.value(3, s.source),
                                               {0.5 + double(s.dx), 0.5 + double(s.dy)}});
        }
    }
    const std::vector<Witness> &at(int x, int y) { return landed_[{x, y}]; }

private:
    std::map<std::pair<int, int>, std::vector<Witness>> landed_;
};

double depth_of(float z) { return focal_px * radius / double(z); }

// A see-through film behind an opaque bar keeps its coverage there, however few views see it.
TEST(Warp, AFilmBehindABarKeepsItsCoverage) {
    const float covers = 0.3f;
    TwoPlanes scene;
    scene.front_covers = [](double x, double) { return x >= 18 && x < 24; };
    std::vector<View> views = five_views(scene, windows_of_size(40, 12), radius);
    for (View &view : views)
        for (std::size_t i = 0; i < view.z.size(); ++i)
            if (view.z[i] == float(scene.back_z))
                for (const std::size_t k : {1u, 3u}) view.image.plane(k)[i] *= covers;
    const Ldi ldi = warped(views);
    std::size_t behind = 0;
    for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel) {
        const TestPixel samples = samples_of(ldi, pixel);
        for (const TestSample &s : samples) EXPECT_FLOAT_EQ(s.alpha, s.z > 5 ? covers : 1);
        behind += samples.size() == 2;
    }
    EXPECT_GE(behind, 2u * 10); // beside both edges of the bar
}

// Extra vision means showing surfaces that no view saw. Every sample's colour must be within the colours of view pixels
// that land within a pixel of it, on its surface (at most surface_px from one of its samples, so twice that from their
// mean). Rim views that look past a pixel's last sample fill the pixel up (coverage.h).
TEST(Warp, NothingIsInvented) {
    const Windows w = windows_of_size(40, 30);
    for (const auto &views : {random_views(w, 6), five_views(fence(), w, radius)})
        for (const WarpOptions &options : {averaging, keeping}) {
            const Ldi ldi = warped(views, options);
            Witnesses witnesses(views);
            const ReprojectedViews placed(views, focal_px, focal_px * radius, 0);
            for_each_pixel(ldi.windows.data, [&](int x, int y) {
                const TestPixel samples = pixel_at(ldi, x, y);
                for (const TestSample &s : samples) {
                    float least = inf, most = -inf;
                    const auto may_fill = [&](const ViewSamples &view, std::uint64_t i, double) {
                        const float colour = view.value(0, i) / view.value(3, i);
                        least = std::min(least, colour);
                        most = std::max(most, colour);
                    };
                    if (&s == &samples.back())
                        votes_on(placed, {x + 0.5 + double(s.dx), y + 0.5 + double(s.dy)}, 1 / double(s.z),
                                 options.surface_px / (focal_px * radius), may_fill);
                    for_each_pixel({{x - 1, y - 1}, {x + 1, y + 1}}, [&](int near_x, int near_y) {
                        for (const Witness &seen : witnesses.at(near_x, near_y)) {
                            if (std::abs(seen.depth - depth_of(s.z)) > 2 * options.surface_px) continue;
                            least = std::min(least, seen.colour);
                            most = std::max(most, seen.colour);
                        }
                    });
                    EXPECT_GE(s.colour / s.alpha, least - 1e-6f);
                    EXPECT_LE(s.colour / s.alpha, most + 1e-6f);
                }
            });
        }
}

// Nothing is left out unless it is in front of the centre view's surface, outside its picture, or other views look past
// it. With averaging, every other view pixel has a sample of its surface where it lands.
TEST(Warp, NothingIsLost) {
    const Windows w = windows_of_size(40, 30);
    for (const auto &views : {random_views(w, 6), five_views(fence(), w, radius)}) {
        const Ldi ldi = warped(views);
        Witnesses witnesses(views);
        const ReprojectedViews placed(views, focal_px, focal_px * radius, 0);
        const auto past = [&](const Witness &seen, int x, int y) {
            const double inverse_z = seen.depth / (focal_px * radius);
            return coverage_by_majority(votes_on(placed, {x + seen.place.x, y + seen.place.y}, inverse_z,
                                                 averaging.surface_px / (focal_px * radius))) < 1;
        };
        std::size_t seen_pixels = 0, lost = 0;
        for_each_pixel(ldi.windows.data, [&](int x, int y) {
            const TestPixel samples = pixel_at(ldi, x, y);
            const bool inside = w.data.intersects(Imath::V2i(x, y));
            const bool empty = inside && views[0].image.at(3, x, y) == 0;
            const double centre = inside ? depth_of(views[0].z[std::size_t(y * 40 + x)]) : inf;
            for (const Witness &seen : witnesses.at(x, y)) {
                ++seen_pixels;
                const double depth = seen.depth;
                const bool found = std::ranges::any_of(samples, [&](const TestSample &s) {
                    return std::abs(depth_of(s.z) - depth) <= 2 * averaging.surface_px;
                });
                lost += !(found || empty || depth > centre || past(seen, x, y));
            }
        });
        EXPECT_GT(seen_pixels, 3 * w.pixels());
        EXPECT_LE(lost,
                  seen_pixels / 2000); // the vote is at the mean position of a surface's samples in a pixel
    }
}

// Red stripes in front of green: no sample mixes them, and the hidden green appears behind the stripes' edges.
TEST(Warp, SurfacesDoNotMixAndTheHiddenAppears) {
    const Windows w = windows_of_size(64, 20);
    const auto views = five_views(fence(), w, radius);
    const Ldi ldi = warped(views);
    std::size_t hidden = 0;
    for_each_pixel(w.data, [&](int x, int y) {
        for (const TestSample &s : pixel_at(ldi, x, y)) {
            const bool front = s.z < 5;
            EXPECT_EQ(s.colour, front ? 1 : 0);
            hidden += !front && views[0].z[std::size_t(y * 64 + x)] == 2;
        }
    });
    // The stripes move by 2.4 px against the back plane: 2 to 3 columns appear at each of a stripe's two edges.
    EXPECT_GE(hidden, std::size_t(20 * 4 * 2 * 2));
    EXPECT_LE(hidden, std::size_t(20 * 4 * 2 * 3));
}

// Unsplit, the nearer surface's light would appear at the depth of the farther one, and a small lamp would have a
// second disc.
TEST(Warp, WhateverAreTwoSurfacesThePixelBetweenThemIsBoth) {
    const View view = make_view(windows_of_size(16, 9), {0, 0}, [](int x, int) {
        const float red = x < 8 ? 1 : x == 8 ? 0.4f : 0;
        return ViewPixel{.z = red >= 0.5f ? 2.0f : 10.0f, .r = 1000 * red, .g = 1 - red};
    });
    for (const double apart : {0.49, 0.51, 0.99, 1.01, 4.0}) { // pixels of disparity
        const Ldi ldi = warped({view}, {.focal_px = 100, .radius = apart / (100 * (1 / 2.0 - 1 / 10.0))});
        const std::uint64_t front = ldi.pixel(4 * 16 + 8).front();
        ASSERT_EQ(ldi.pixel(4 * 16 + 8).size(), apart > 0.5 ? 2u : 1u) << apart;
        if (apart < 0.5) continue;
        EXPECT_FLOAT_EQ(ldi.z[front], 2);
        EXPECT_NEAR(ldi.values[0][front], 400, 1);
        EXPECT_NEAR(ldi.values[0][front + 1], 0, 1e-3);
    }
}

// Sub-pixel positions of samples are kept: a picture whose colour encodes its position shows this.
TEST(Warp, SubPixelPositionsAreKept) {
    TwoPlanes scene = fence();
    scene.front_red = [](double x, double y) { return float(x + 0.25 * y); };
    const Windows w = windows_of_size(64, 20);
    const Ldi ldi = warped(five_views(scene, w, radius));
    int checked = 0;
    for_each_pixel(ldi.windows.data, [&](int x, int y) {
        for (const TestSample &s : pixel_at(ldi, x, y)) {
            if (s.z > 5) continue; // only the front plane, whose colour is red
            ++checked;
            EXPECT_NEAR(s.colour, x + 0.5 + double(s.dx) + 0.25 * (y + 0.5 + double(s.dy)), 1e-4);
        }
    });
    EXPECT_GT(checked, 24 * 20);
}

TEST(Warp, AveragingLowersTheNoiseAndKeepsTheMean) {
    TwoPlanes scene = one_plane([](double, double) { return 0.5f; });
    scene.noise = 0.5f;
    const Windows w = windows_of_size(96, 96);
    const auto views = five_views(scene, w, radius);
    const Ldi ldi = warped(views);
    const Imath::Box2i inner({4, 4}, {91, 91}); // where all views land
    const auto deviation = [&](const auto &value_at) {
        double sum = 0, squares = 0;
        for_each_pixel(inner, [&](int x, int y) {
            const double value = double(value_at(x, y));
            sum += value;
            squares += (value - 0.5) * (value - 0.5);
        });
        EXPECT_NEAR(sum / (88 * 88), 0.5, 0.01);
        return std::sqrt(squares / (88 * 88));
    };
    double weight = 0;
    const double before = deviation([&](int x, int y) { return views[0].image.at(0, x, y); });
    const double after = deviation([&](int x, int y) {
        const TestPixel samples = pixel_at(ldi, x, y);
        EXPECT_EQ(samples.size(), 1u);
        weight += double(samples[0].weight);
        return samples[0].colour;
    });
    EXPECT_NEAR(before, 0.5 / std::sqrt(3.0), 0.01);
    EXPECT_LT(after, before / 2); // five views: 1 / sqrt(5) at best, if each pixel takes as much of each
    EXPECT_NEAR(weight / (88 * 88), 5, 0.2);
}

} // namespace
} // namespace sparselens
