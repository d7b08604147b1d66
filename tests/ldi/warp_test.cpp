#include "base/error.h"
#include "ldi/order.h"
#include "ldi/reproject.h"
#include "ldi/warp.h"
#include "support/ldi_samples.h"
#include "support/scratch_folder.h"
#include "support/views.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace sparselens {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr double focal_px = 100, radius = 0.06;
const WarpOptions averaging{.focal_px = focal_px, .radius = radius};
const WarpOptions keeping{.focal_px = focal_px, .radius = radius, .merge = Merge::keep};

Ldi warped(const std::vector<View> &views, const WarpOptions &options = averaging) {
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
    EXPECT_EQ(a.values, b.values);
}

// Stripes of a front plane before a back plane.
TwoPlanes fence() {
    TwoPlanes scene;
    scene.front_covers = [](double x, double) { return std::fmod(x + 1000, 16) < 6; };
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

TEST(Warp, OnePixel) {
    const Windows w = windows_of_size(1, 1);
    const auto all_at = [&](float z) {
        TwoPlanes scene;
        scene.back_z = double(z);
        return warped(five_views(scene, w, radius));
    };
    EXPECT_EQ(all_at(1).samples(), 1u);   // the others left the picture
    EXPECT_EQ(all_at(inf).samples(), 1u); // all of one surface
    EXPECT_GT(all_at(1000).weight[0], 1.0f);
}

TEST(Warp, IdenticalViewsChangeNothing) {
    const View view = random_view(windows_of_size(33, 21), {0, 0}, 5);
    const Ldi one = warped({view}), five = warped({view, view, view, view, view});
    EXPECT_EQ(one.z, five.z);
    EXPECT_EQ(one.values, five.values);
    EXPECT_EQ(five.weight, std::vector<float>(five.samples(), 5));
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
            EXPECT_EQ(samples[0].z, views[0].z[pixel]); // so nothing lies before it
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

// Whatever the views show: z ascends strictly, so at infinity lies at most one sample.
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

// The view pixels that may go into a sample: those that land within a pixel of it, at its depth.
struct Witnesses {
    std::vector<std::vector<std::pair<ReprojectedSample, const View *>>> landed; // by pixel of the centre

    Witnesses(const std::vector<View> &views, const Windows &w) : landed(w.pixels()) {
        for (const View &view : views) {
            std::vector<ReprojectedSample> samples;
            Reprojection(view, focal_px).append_rows(w.data.min.y, w.data.max.y, samples);
            for (const ReprojectedSample &s : samples)
                if (s.x >= w.data.min.x && s.x <= w.data.max.x)
                    landed[std::size_t(s.y - w.data.min.y) * std::size_t(w.width()) +
                           std::size_t(s.x - w.data.min.x)]
                        .emplace_back(s, &view);
        }
    }
};

// Extra vision: seeing what no view saw. Every sample lies among view pixels of its depth, and its colour among
// theirs.
TEST(Warp, NothingIsInvented) {
    const Windows w = windows_of_size(40, 30);
    for (const auto &views : {random_views(w, 6), five_views(fence(), w, radius)})
        for (const WarpOptions &options : {averaging, keeping}) {
            const Ldi ldi = warped(views, options);
            const Witnesses witnesses(views, w);
            for (int y = 0; y < 30; ++y)
                for (int x = 0; x < 40; ++x)
                    for (const TestSample &s : samples_of(ldi, std::size_t(y * 40 + x))) {
                        float least = inf, most = -inf;
                        for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, 29); ++ny)
                            for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, 39); ++nx)
                                for (const auto &[sample, view] :
                                     witnesses.landed[std::size_t(ny * 40 + nx)]) {
                                    const double apart = focal_px * radius *
                                                         std::abs(double(sample.inverse_z) - 1 / double(s.z));
                                    if (apart > options.surface_px) continue;
                                    const float colour = view->image.plane(0)[sample.source];
                                    least = std::min(least, colour);
                                    most = std::max(most, colour);
                                }
                        ASSERT_GE(s.colour, least - 1e-6f);
                        ASSERT_LE(s.colour, most + 1e-6f);
                    }
        }
}

// And nothing that a view saw is left out: averaging, every view pixel that lands in the picture has a sample of its
// depth there.
TEST(Warp, NothingIsLost) {
    const Windows w = windows_of_size(40, 30);
    for (const auto &views : {random_views(w, 6), five_views(fence(), w, radius)}) {
        const Ldi ldi = warped(views);
        const Witnesses witnesses(views, w);
        for (std::size_t pixel = 0; pixel < w.pixels(); ++pixel)
            for (const auto &[seen, view] : witnesses.landed[pixel]) {
                const double depth = focal_px * radius * double(seen.inverse_z);
                const TestPixel samples = samples_of(ldi, pixel);
                ASSERT_TRUE(std::ranges::any_of(samples, [&](const TestSample &s) {
                    return std::abs(focal_px * radius / double(s.z) - depth) <= averaging.surface_px;
                }));
            }
    }
}

// Red stripes in front of green: no sample mixes them, and behind the stripes' edges the hidden green appears.
TEST(Warp, SurfacesDoNotMixAndTheHiddenAppears) {
    const Windows w = windows_of_size(64, 20);
    const auto views = five_views(fence(), w, radius);
    const Ldi ldi = warped(views);
    std::size_t hidden = 0;
    for (std::size_t pixel = 0; pixel < w.pixels(); ++pixel)
        for (const TestSample &s : samples_of(ldi, pixel)) {
            const bool front = s.z < 5;
            ASSERT_EQ(s.colour, front ? 1 : 0);
            hidden += !front && views[0].z[pixel] == 2;
        }
    // The stripes move by 2.4 px against the back plane: at each of a stripe's two edges 2 to 3 columns appear.
    EXPECT_GE(hidden, std::size_t(20 * 4 * 2 * 2));
    EXPECT_LE(hidden, std::size_t(20 * 4 * 2 * 3));
}

// Where samples lie is kept below the pixel: a picture whose colour is its position says so.
TEST(Warp, SubPixelPositionsAreKept) {
    TwoPlanes scene = fence();
    scene.front_red = [](double x, double y) { return float(x + 0.25 * y); };
    scene.back_green = scene.front_red;
    const Windows w = windows_of_size(64, 20);
    const Ldi ldi = warped(five_views(scene, w, radius));
    int checked = 0;
    for (int y = 2; y < 18; ++y)
        for (int x = 4; x < 60; ++x) {
            const std::size_t pixel = std::size_t(y * 64 + x);
            for (std::uint64_t i = ldi.begin[pixel] + 1; i < ldi.begin[pixel + 1]; ++i, ++checked) {
                const double at = x + 0.5 + double(ldi.dx[i]) + 0.25 * (y + 0.5 + double(ldi.dy[i]));
                ASSERT_NEAR(ldi.values[ldi.z[i] < 5 ? 0 : 1][i], at, 1e-4);
            }
        }
    EXPECT_GT(checked, 100);
}

TEST(Warp, AveragingLowersTheNoiseAndKeepsTheMean) {
    TwoPlanes scene;
    scene.back_green = [](double, double) { return 0.5f; };
    scene.noise = 0.5f;
    const Windows w = windows_of_size(96, 96);
    const auto views = five_views(scene, w, radius);
    const Ldi ldi = warped(views);
    const auto deviation = [&](const auto &green_of) {
        double sum = 0, squares = 0;
        int count = 0;
        for (int y = 4; y < 92; ++y)
            for (int x = 4; x < 92; ++x, ++count) {
                const double green = double(green_of(std::size_t(y * 96 + x)));
                sum += green;
                squares += (green - 0.5) * (green - 0.5);
            }
        EXPECT_NEAR(sum / count, 0.5, 0.01);
        return std::sqrt(squares / count);
    };
    const double before = deviation([&](std::size_t pixel) { return views[0].image.plane(1)[pixel]; });
    const double after = deviation([&](std::size_t pixel) { return ldi.values[1][ldi.begin[pixel]]; });
    EXPECT_NEAR(before, 0.5 / std::sqrt(3.0), 0.01);
    EXPECT_LT(after,
              before / std::sqrt(4.0)); // five views: at best 1 / sqrt(5), less for what splatting smooths
    const double weight = [&] {
        double sum = 0;
        for (std::size_t pixel = 0; pixel < w.pixels(); ++pixel) sum += double(ldi.weight[ldi.begin[pixel]]);
        return sum / double(w.pixels());
    }();
    EXPECT_NEAR(weight, 5, 0.2); // but for what left the picture
}

TEST(Warp, TheOrderOfRimViewsDoesNotMatter) {
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

// Also where they stand at one point, as renders of one view with other noise do.
TEST(Warp, TheOrderOfViewsAtOnePointDoesNotMatter) {
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

TEST(Warp, TheNumberOfThreadsDoesNotMatter) {
    const auto views = random_views(windows_of_size(40, 90), 5);
    const auto with_threads = [&](std::size_t threads, const WarpOptions &options) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return warped(views, options);
    };
    for (const WarpOptions &options : {averaging, keeping})
        expect_same_bits(with_threads(1, options), with_threads(4, options));
}

TEST(Warp, DataWindowsMayDiffer) {
    TwoPlanes scene;
    scene.back_green = [](double x, double) { return float(x); };
    Windows whole = windows_of_size(40, 30), crop = whole;
    crop.data = Imath::Box2i({30, -5}, {60, 9});
    const std::vector<View> views{scene.view(whole, {0, 0}), scene.view(crop, {0.05, 0.02})};
    const Ldi ldi = warped(views);
    EXPECT_EQ(ldi.windows, whole);
    for (std::size_t pixel = 0; pixel < whole.pixels(); ++pixel) {
        ASSERT_EQ(samples_of(ldi, pixel).size(), 1u); // one plane, whichever view saw it
        EXPECT_NEAR(ldi.values[1][pixel], views[0].image.plane(1)[pixel], 0.5); // from within the pixel
    }
    const Ldi of_crop = warped({scene.view(crop, {0, 0}), scene.view(whole, {0.05, 0.02})});
    EXPECT_EQ(of_crop.windows, crop);
    EXPECT_GT(*std::ranges::max_element(of_crop.weight), 1.5f);
}

TEST(Warp, DisplayWindowsMayNot) {
    View centre = random_view(windows_of_size(8, 8), {0, 0}, 1),
         rim = random_view(windows_of_size(8, 9), {1, 0}, 2);
    centre.name = "centre.exr";
    rim.name = "rim.exr";
    EXPECT_EQ(what_of<Error>([&] {
                  warped({centre, rim});
              }),
              "rim.exr: its display window differs from the centre view's (centre.exr)");
}

TEST(Warp, ChannelsAreMatchedByName) {
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

TEST(Warp, IdsAreNeverAveraged) {
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
    for (std::size_t pixel = 0; pixel < w.pixels(); ++pixel)
        for (std::uint64_t i = ldi.begin[pixel]; i < ldi.begin[pixel + 1]; ++i) {
            const bool of_centre = ldi.z[i] == views[0].z[pixel] && views[0].image.plane(3)[pixel] != 0;
            EXPECT_TRUE(!of_centre || ldi.values[4][i] == 13);
        }
}

TEST(Warp, EmptyPixelsOfRimViewsAddNothing) {
    const Windows w = windows_of_size(12, 12);
    const View centre = random_view(w, {0, 0}, 1);
    const View empty = make_view(w, {0.05, 0}, [](int, int) { return ViewPixel{.z = 0.5f, .r = 9, .a = 0}; });
    expect_same_bits(warped({centre, empty}), warped({centre}));
}

// Where the centre view is empty, averaging takes what the others saw.
TEST(Warp, AnEmptyCentreIsFilled) {
    const Windows w = windows_of_size(12, 12);
    const View nothing = make_view(w, {0, 0}, [](int, int) { return ViewPixel{.a = 0}; });
    const View rim = make_view(w, {0.05, 0}, [](int, int) { return ViewPixel{.z = inf, .r = 3}; });
    const Ldi ldi = warped({nothing, rim});
    EXPECT_EQ(ldi.samples(), w.pixels());
    EXPECT_EQ(ldi.values[0], std::vector<float>(w.pixels(), 3));
    EXPECT_EQ(warped({nothing, rim}, keeping).samples(), 0u);
}

} // namespace
} // namespace sparselens
