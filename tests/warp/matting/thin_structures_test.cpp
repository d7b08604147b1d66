#include "deep/flatten.h"
#include "support/views.h"
#include "warp/matting/thin_structures.h"
#include "warp/silhouettes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace sparselens {
namespace {

constexpr double scale = 20; // of depths 2 and 10: 8 pixels of CoC apart
constexpr int size = 40;

// Strands at depth 2 that cover a random share of each pixel, before a wall at depth 10 with a lamp of 4 by 4 pixels. A
// pixel has the strands' depth with a probability equal to their coverage.
struct Strands {
    float lamp = 0.8f, wall = 0.8f, strand = 0.1f;
    std::vector<float> share;
    View view;

    explicit Strands(float lamp_radiance, std::uint32_t seed = 1) : lamp(lamp_radiance) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> unit(0, 1);
        for (int i = 0; i < size * size; ++i) share.push_back(unit(random));
        view = make_view(windows_of_size(size, size), {0, 0}, [&](int x, int y) {
            const float a = share[std::size_t(y * size + x)], v = a * strand + (1 - a) * behind(x, y);
            return ViewPixel{.z = unit(random) < a ? 2.0f : 10.0f, .r = v, .g = v, .b = v};
        });
    }
    float behind(int x, int y) const { return x >= 18 && x < 22 && y >= 18 && y < 22 ? lamp : wall; }
    Ldi separated() const {
        ViewSamples samples(view, view.image.channels);
        separate_silhouettes(samples, scale, 0.5);
        return samples.as_ldi();
    }
};

bool among(const View &view, int x, int y) {
    const ViewSamples samples(view, view.image.channels);
    return among_strands(SamplesAround(samples, scale), x, y);
}

TEST(ThinStructures, StrandsAreKnownByDepthsThatJump) {
    const Strands hair(0.8f);
    int found = 0;
    for (int y = 4; y < size - 4; ++y)
        for (int x = 4; x < size - 4; ++x) found += among(hair.view, x, y);
    EXPECT_GT(found, 0.95 * (size - 8) * (size - 8));
    const std::vector<std::function<bool(int x, int y)>> solids{
        [](int x, int) { return x < 10; },             // an edge
        [](int x, int y) { return x < 10 && y < 10; }, // a corner
        [](int x, int y) { return 3 * x + y < 40; },   // a slanted edge
        [](int x, int) { return x == 10; },            // a wire
        [](int x, int) { return x % 2 == 0; },         // bars
    };
    for (std::size_t k = 0; k < solids.size(); ++k) {
        const View view = make_view(windows_of_size(20, 20), {0, 0}, [&](int x, int y) {
            return ViewPixel{.z = solids[k](x, y) ? 2.0f : 10.0f};
        });
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 20; ++x) EXPECT_FALSE(among(view, x, y)) << k << ' ' << x << ' ' << y;
    }
}

// Whatever the random depth of a pixel, strands get their share of it; else one of the two depths gets everything.
TEST(ThinStructures, StrandsCoverTheirShare) {
    const Strands hair(0.8f);
    const Ldi ldi = hair.separated();
    double error = 0, whole_error = 0;
    int count = 0;
    for (int y = 4; y < size - 4; ++y)
        for (int x = 4; x < size - 4; ++x) {
            const std::size_t pixel = std::size_t(y * size + x);
            double covered = 0;
            for (const std::uint64_t i : ldi.pixel(pixel))
                if (ldi.z[i] < 5) covered += double(ldi.values[3][i]);
            const double share = double(hair.share[pixel]), whole = hair.view.z[pixel] < 5 ? 1 : 0;
            error += std::abs(covered - share);
            whole_error += std::abs(whole - share);
            ++count;
        }
    EXPECT_GT(whole_error / count, 0.3); // a third is expected
    EXPECT_LT(error, 0.4 * whole_error); // the purest pixels nearby are not quite pure
    const Image flat = flatten(ldi);
    for (std::size_t i = 0; i < flat.values.size(); ++i)
        EXPECT_NEAR(flat.values[i], hair.view.image.values[i], 1e-5);
}

// Strands at random before a wall whose colour is different in every pixel, and a second view without the strands. The
// wall's blue is 1.5 times its red, unless it has none; then the strands have .02 less blue where they are mixed.
struct BeforeAWall {
    std::vector<float> share, wall;
    std::vector<View> views;
    std::vector<ViewSamples> samples;
    std::vector<ViewMapping> mappings;

    explicit BeforeAWall(bool blue) {
        std::mt19937 random(5);
        std::uniform_real_distribution<float> unit(0, 1);
        for (int i = 0; i < size * size; ++i) {
            share.push_back(unit(random) < 0.3f ? 1 : unit(random));
            wall.push_back(0.3f + unit(random));
        }
        for (const bool strands : {true, false})
            views.push_back(
                make_view(windows_of_size(size, size), {strands ? 0.0 : 0.1, 0}, [&](int x, int y) {
                    const std::size_t i = std::size_t(y * size + x);
                    const float a = strands ? share[i] : 0, b = 1 - a;
                    const float lacks = blue || b == 0 ? 0 : 0.02f;
                    return ViewPixel{.z = unit(random) < a ? 2.0f : std::numeric_limits<float>::infinity(),
                                     .r = a * 0.25f + b * wall[i],
                                     .g = a * 0.12f + b * wall[i] * 1.1f,
                                     .b =
                                         std::max(a * 0.05f + (blue ? b * wall[i] * 1.5f : 0) - lacks, 0.0f)};
                }));
        for (const View &view : views) {
            samples.emplace_back(view, view.image.channels);
            mappings.emplace_back(view.position, 100, view.image.windows);
        }
    }
    Ldi separated(bool by_both) const {
        ViewSamples own(views[0], views[0].image.channels);
        const BackgroundFromViews others(samples, mappings, 0, scale);
        separate_silhouettes(own, scale, 0.5, {}, by_both ? &others : nullptr);
        return own.as_ldi();
    }
};

// The pixels around do not tell what is behind one of them; a view that shows the wall does.
TEST(ThinStructures, OtherViewsTellWhatIsBehind) {
    const BeforeAWall scene(true);
    const auto error_of = [&](bool by_both) {
        const Ldi ldi = scene.separated(by_both);
        double error = 0;
        for (int y = 4; y < size - 4; ++y)
            for (int x = 4; x < size - 4; ++x) {
                double covered = 0;
                for (const std::uint64_t i : ldi.pixel(std::size_t(y * size + x)))
                    if (ldi.z[i] < 5) covered += double(ldi.values[3][i]);
                error += std::abs(covered - double(scene.share[std::size_t(y * size + x)]));
            }
        return error / ((size - 8) * (size - 8));
    };
    const double alone = error_of(false), together = error_of(true);
    EXPECT_LT(together, 0.03);
    EXPECT_GT(alone, 2 * together);
}

TEST(ThinStructures, BothSurfacesOfAPixelAreLight) {
    for (const bool blue : {false, true}) {
        const BeforeAWall scene(blue);
        const Ldi ldi = scene.separated(true);
        const Image flat = flatten(ldi);
        for (std::size_t i = 0; i < flat.values.size(); ++i)
            EXPECT_NEAR(flat.values[i], scene.views[0].image.values[i], 1e-5);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_GE(std::ranges::min(ldi.values[k]), -1e-6f);
    }
}

// A lamp 400 times as bright as the strands shines at its own depth, and none of its light is lost.
TEST(ThinStructures, LightBetweenStrandsIsTheLamps) {
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        const Strands hair(40, seed);
        const Ldi ldi = hair.separated();
        double all = 0, of_strands = 0, before = 0;
        const Image flat = flatten(ldi);
        for (int y = 18; y < 22; ++y)
            for (int x = 18; x < 22; ++x) {
                const std::size_t pixel = std::size_t(y * size + x);
                all += double(flat.values[pixel]);
                before += double(hair.view.image.values[pixel]);
                for (const std::uint64_t i : ldi.pixel(pixel))
                    if (ldi.z[i] < 5) of_strands += double(ldi.values[0][i]);
            }
        EXPECT_NEAR(all, before, 1e-4 * before) << seed;
        EXPECT_LT(of_strands, 0.01 * before) << seed; // they get half of it if pixel depths decide
    }
}

} // namespace
} // namespace sparselens
