#include "base/error.h"
#include "deep/view_samples.h"
#include "support/ldi_samples.h"
#include "support/scratch_folder.h"
#include "support/views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace sparselens {
namespace {

TEST(ViewSamples, PixelsThatShowSomethingAreSamples) {
    const View view = random_view({Imath::Box2i({0, 0}, {9, 9}), Imath::Box2i({-3, 2}, {12, 20})}, {1, 2}, 3);
    const Ldi ldi = ViewSamples(view, view.image.channels).as_ldi();
    EXPECT_EQ(ldi.windows, view.image.windows);
    EXPECT_EQ(ldi.weight, std::vector<float>(ldi.samples(), 1));
    EXPECT_TRUE(ldi.dx.empty() && ldi.dy.empty() && ldi.z_back.empty());
    ASSERT_EQ(ldi.begin.size(), view.z.size() + 1);
    for (std::size_t pixel = 0; pixel < view.z.size(); ++pixel) {
        ASSERT_EQ(ldi.pixel(pixel).size(), view.image.plane(3)[pixel] == 0 ? 0u : 1u);
        if (ldi.pixel(pixel).empty()) continue;
        const std::uint64_t i = ldi.pixel(pixel).front();
        EXPECT_EQ(ldi.z[i], view.z[pixel]);
        for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(ldi.values[k][i], view.image.plane(k)[pixel]);
    }
}

// From any pixel on, across words of 64 pixels.
TEST(ViewSamples, RunsOfPixelsAreAsPixelByPixel) {
    const View view = random_view(windows_of_size(50, 10), {0, 0}, 4);
    ViewSamples samples(view, view.image.channels);
    samples.replace([](std::size_t i) { return i % 5 == 0; },
                    [&](std::size_t i, Ldi &out) {
                        for (std::size_t n = 0; n < 1 + i % 2; ++n)
                            append(out, samples, float(n + 1), 1, std::vector<Term>{{i, double(n) + 2}});
                    });
    for (const std::size_t first : {0u, 3u, 64u, 130u})
        for (const std::size_t count : {1u, 61u, 200u}) {
            std::vector<float> values(count), depths(count);
            samples.front_values(1, first, values);
            samples.single_depths(first, depths);
            for (std::size_t n = 0; n < count; ++n) {
                const SampleRange range = samples.pixel(first + n);
                ASSERT_EQ(values[n], range.empty() ? 0 : samples.value(1, range.front())) << first + n;
                ASSERT_EQ(std::isnan(depths[n]), range.size() != 1) << first + n;
                if (range.size() == 1) {
                    ASSERT_EQ(depths[n], samples.z(range.front()));
                }
            }
        }
}

TEST(ViewSamples, ChannelsComeInTheOrderAskedFor) {
    const View view = random_view(windows_of_size(2, 2), {0, 0}, 1);
    const Ldi ldi = ViewSamples(view, std::vector<Channel>{{"A"}, {"G"}}).as_ldi();
    ASSERT_EQ(ldi.values.size(), 2u);
    EXPECT_EQ(ldi.alpha(), 0u);
    EXPECT_EQ(ldi.values[1][0], view.image.plane(1)[ldi.begin[1] == 1 ? 0 : 1]);
    EXPECT_EQ(what_of<Error>([&] { ViewSamples(view, std::vector<Channel>{{"albedo.R"}}); }),
              "view: has no channel albedo.R, which the centre view has");
}

TEST(ViewSamples, WithoutAlphaEverythingIsVisible) {
    View view = random_view(windows_of_size(8, 8), {0, 0}, 1);
    view.image = Image(view.image.windows, {{"Y"}});
    EXPECT_EQ(ViewSamples(view, view.image.channels).as_ldi().samples(), 64u);
}

TEST(ViewSamples, PixelsThatAreTakenAreTheSame) {
    View view = random_view({Imath::Box2i({0, 0}, {29, 19}), Imath::Box2i({-3, 2}, {71, 30})}, {1, 2}, 5);
    for (float &red : view.image.plane(0)) red = std::round(red * 64) / 64; // a half
    const Ldi seen = ViewSamples(view, view.image.channels).as_ldi();
    const std::vector<Channel> channels = view.image.channels;
    const Ldi taken = ViewSamples(std::move(view), channels).as_ldi();
    EXPECT_EQ(view.image.values.capacity() + view.z.capacity(), 0u);
    EXPECT_EQ(taken.begin, seen.begin);
    EXPECT_EQ(taken.z, seen.z);
    EXPECT_EQ(taken.values, seen.values);
}

// Slow and simple: each pixel's samples are in a list of their own.
TEST(ViewSamples, ReplacedPixelsHaveTheirNewSamplesAndTheOthersTheirOwn) {
    const View view =
        random_view({Imath::Box2i({0, 0}, {29, 19}), Imath::Box2i({-3, 2}, {71, 30})}, {1, 2}, 5);
    ViewSamples samples(view, view.image.channels);
    const Ldi before = samples.as_ldi();
    const std::size_t moved = view.image.windows.index(Imath::V2i(11, 7));
    if (!samples.pixel(moved).empty()) samples.set_z(samples.pixel(moved).front(), 77);
    const auto number_of = [&](std::size_t pixel) { // number of replacing samples; 0: not replaced
        return before.pixel(pixel).empty() || pixel == moved ? 0 : pixel % 4 == 3 ? pixel / 4 % 3 : 0;
    };
    samples.replace([](std::size_t pixel) { return pixel % 4 == 3; },
                    [&](std::size_t pixel, Ldi &out) {
                        const std::uint64_t own = pixel;
                        for (std::size_t n = 0; n < number_of(pixel); ++n)
                            append(out, samples, float(n + 1), 0.5f, std::vector<Term>{{own, double(n) + 2}});
                    });
    for (std::size_t pixel = 0; pixel < view.z.size(); ++pixel) {
        const SampleRange now = samples.pixel(pixel);
        if (number_of(pixel) == 0) {
            ASSERT_EQ(now.size(), before.pixel(pixel).size());
            for (const std::uint64_t i : now) {
                EXPECT_EQ(samples.z(i), pixel == moved ? 77 : view.z[pixel]);
                EXPECT_EQ(samples.weight(i), 1);
                EXPECT_EQ(samples.value(2, i), view.image.plane(2)[pixel]);
            }
            continue;
        }
        ASSERT_EQ(now.size(), number_of(pixel));
        for (const std::uint64_t i : now) {
            const auto n = float(i - now.from);
            EXPECT_EQ(samples.z(i), n + 1);
            EXPECT_EQ(samples.weight(i), 0.5f);
            EXPECT_EQ(samples.value(2, i), (n + 2) * view.image.plane(2)[pixel]);
        }
    }
    const Ldi some = samples.rows(3, 9), all = samples.as_ldi();
    EXPECT_EQ(some.samples(), samples.count(3, 9));
    EXPECT_EQ(some.windows.data, Imath::Box2i({-3, 5}, {71, 10}));
    for (std::size_t i = 0; i < some.samples(); ++i) {
        EXPECT_EQ(some.z[i], all.z[all.begin[3 * 75] + i]);
        EXPECT_EQ(some.values[1][i], all.values[1][all.begin[3 * 75] + i]);
    }
}

} // namespace
} // namespace sparselens
