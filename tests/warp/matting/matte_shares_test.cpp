// Coverages of Cryptomattes when pixels become two samples, when views are averaged, and through the lens.
#include "deep/flatten.h"
#include "dof/methods.h"
#include "support/mattes.h"
#include "warp/silhouettes.h"
#include "warp/warp_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sparselens {
namespace {

using namespace warping;

constexpr double scale = 20; // of depths 2 and 10: 8 pixels of disparity apart
constexpr int objects = 4;   // of the 6 that fit into the pairs

using Pairs = std::vector<IdCoverage::Pair>;

// The view with pairs(x, y) in its pixels.
View with_mattes(View view, const std::function<Pairs(int x, int y)> &pairs) {
    Image image(view.image.windows, channels_with_matte(3));
    for (std::size_t k = 0; k < 4; ++k) std::ranges::copy(view.image.plane(k), image.plane(k).begin());
    const Matte matte = find_mattes(image.channels)[0];
    for (std::size_t i = 0; i < image.windows.pixels(); ++i) {
        const Imath::V2i at = image.windows.pixel(i);
        IdCoverage coverages;
        for (const auto &[id, coverage] : pairs(at.x, at.y)) coverages.add(id, coverage);
        write_pairs(matte, coverages.ranked(),
                    [&](std::size_t k, float value) { image.plane(k)[i] = value; });
    }
    view.image = std::move(image);
    return view;
}

double sum_in(const Ldi &ldi, std::uint64_t sample) {
    double sum = 0;
    const Matte matte = find_mattes(ldi.channels)[0];
    for (const Matte::Rank &rank : matte.ranks) sum += double(ldi.values[rank.coverage][sample]);
    return sum;
}

double sum_in(const Image &picture, std::size_t pixel) {
    double sum = 0;
    const Matte matte = find_mattes(picture.channels)[0];
    for (const Matte::Rank &rank : matte.ranks) sum += double(picture.plane(rank.coverage)[pixel]);
    return sum;
}

// Red at depth 2 on the left, green at depth 10 on the right; column 8 is 0.4 red, with the given pairs.
Ldi edge(const Pairs &mixed) {
    const View view = make_view(windows_of_size(16, 9), {0, 0}, [](int x, int) {
        const float red = x < 8 ? 1 : x == 8 ? 0.4f : 0;
        return ViewPixel{.z = red >= 0.5f ? 2.0f : 10.0f, .r = red, .g = 1 - red};
    });
    const View matted = with_mattes(view, [&](int x, int) {
        return x == 8 ? mixed : Pairs{{hashed(x < 8 ? 1 : 2), 1}};
    });
    ViewSamples samples(matted, matted.image.channels);
    separate_silhouettes(samples, scale, 0.5);
    return samples.as_ldi();
}

double coverage_in(const Ldi &ldi, float id, std::uint64_t sample) {
    return coverage_of(find_mattes(ldi.channels), id, [&](std::size_t k) { return ldi.values[k][sample]; });
}

// By its colour, red covers about 0.4 of the pixel. Any pairs are shared out, and none is created.
TEST(MatteShares, BothSurfacesAddUpToWhatTheyCover) {
    const std::vector<Pairs> cases{{{hashed(1), 0.4}, {hashed(2), 0.6}},
                                   {{hashed(1), 0.7}, {hashed(2), 0.3}},
                                   {{hashed(1), 0.1}, {hashed(2), 0.9}},
                                   {{hashed(2), 1}},
                                   {{hashed(3), 0.5}, {hashed(2), 0.5}}};
    for (const Pairs &mixed : cases) {
        const Ldi ldi = edge(mixed);
        const std::uint64_t front = ldi.pixel(4 * 16 + 8).front(), behind = front + 1;
        ASSERT_EQ(ldi.pixel(4 * 16 + 8).size(), 2u);
        const double share = double(ldi.values[3][front]);
        EXPECT_NEAR(sum_in(ldi, front), share, 1e-6);
        EXPECT_NEAR(sum_in(ldi, behind), 1, 1e-6);
        for (const auto &[id, coverage] : mixed)
            EXPECT_NEAR(coverage_in(ldi, id, front) + (1 - share) * coverage_in(ldi, id, behind), coverage,
                        1e-6);
    }
    const Ldi right = edge(cases[0]);
    const std::uint64_t front = right.pixel(4 * 16 + 8).front();
    EXPECT_NEAR(coverage_in(right, hashed(1), front), 0.4, 0.02);
    EXPECT_NEAR(coverage_in(right, hashed(2), front + 1), 1, 0.02);
}

// Coverage without an object is shared out like an object.
TEST(MatteShares, WhatHasNoObjectTakesItsPart) {
    const Ldi ldi = edge({{hashed(2), 0.6}}); // the red surface has no object here
    const std::uint64_t front = ldi.pixel(4 * 16 + 8).front();
    EXPECT_NEAR(coverage_in(ldi, hashed(2), front), 0.0, 0.02);
    EXPECT_NEAR(coverage_in(ldi, hashed(2), front + 1), 1, 0.02);
}

// Random depths and colours, opaque. Each pixel has up to three objects that cover it fully.
std::vector<View> views_at_random() {
    std::vector<View> views;
    for (View &view : random_views(windows_of_size(40, 24), 5)) {
        for (float &alpha : view.image.plane(3)) alpha = 1;
        const auto seed = std::uint32_t(views.size());
        views.push_back(with_mattes(std::move(view), [seed](int x, int y) {
            const double a = random_unit(x, y, seed), b = (1 - a) * random_unit(x, y, 10 + seed);
            const auto object = [&](std::uint32_t n) {
                return hashed(std::uint32_t(objects * random_unit(x, y, 20 * n + seed)));
            };
            return Pairs{{object(1), a}, {object(2), b}, {object(3), 1 - a - b}};
        }));
    }
    return views;
}

TEST(MatteShares, CoveragesOfOpaqueViewsAddUpToOne) {
    WarpOptions options = averaging;
    options.split_silhouettes = true;
    const Ldi ldi = warped(views_at_random(), options);
    std::size_t partial = 0;
    for (std::uint64_t i = 0; i < ldi.samples(); ++i) {
        EXPECT_NEAR(sum_in(ldi, i), double(ldi.values[3][i]), 1e-5);
        partial += ldi.values[3][i] < 0.9f;
    }
    EXPECT_GT(partial, ldi.samples() / 20); // otherwise this proves little
    const Image flat = flatten(ldi);
    Progress silent;
    const Imath::Box2i &frame = ldi.windows.display;
    const ThinLens lens{.radius = radius, .focal_px = focal_px, .focus = 3};
    const Image seen = gather_mattes(ldi, lens, frame, {.quality = Quality::draft}, silent);
    for (std::size_t i = 0; i < seen.windows.pixels(); ++i) {
        const Imath::V2i at = seen.windows.pixel(i);
        EXPECT_NEAR(sum_in(flat, flat.windows.index(at)), 1, 1e-3);
        EXPECT_NEAR(sum_in(seen, i), 1, 1e-3);
    }
}

} // namespace
} // namespace sparselens
