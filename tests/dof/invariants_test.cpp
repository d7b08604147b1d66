// Properties of the lens gather for any picture, checked on random LDIs.
#include "base/numbers.h"
#include "deep/tidy.h"
#include "dof/lens/lens_gather.h"
#include "support/lens_ldi.h"
#include "support/views.h"
#include "warp/warp.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5}; // CoC up to 7.7 px behind focus

Image gather(const Ldi &ldi, int lens_samples = 0) {
    Progress silent;
    return lens_gather(ldi, lens, ldi.windows.data, {.lens_samples = lens_samples}, silent);
}

double rms_difference(const Image &a, const Image &b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        sum += std::pow(double(a.values[i]) - double(b.values[i]), 2);
    return std::sqrt(sum / double(a.values.size()));
}

// Random samples, 0 to 3 per pixel, in the pixels of `inside`, at different depths. Offsets have few bits, so that they
// are the same floats in any pixel.
std::vector<Sample> random_pixel(int x, int y, std::uint32_t seed) {
    std::vector<Sample> samples;
    const auto random = [&](std::uint32_t k) { return random_unit(x, y, seed + 31 * k); };
    for (std::uint32_t i = 0; i < std::uint32_t(4 * random(0)); ++i) {
        const double c = -7 + 4 * std::floor(3 * random(10 * i + 1)) + random(10 * i + 2);
        const float a = random(10 * i + 3) < 0.6 ? 1.0f : float(random(10 * i + 4));
        const float lamp = random(10 * i + 5) > 0.99 ? 60.0f : 1.0f;
        const auto offset = [&](std::uint32_t k) { return float(std::floor(random(k) * 64) / 64 - 0.5); };
        samples.push_back({depth_of(lens, c),
                           {a * lamp * float(random(10 * i + 6)), a * float(random(10 * i + 7)), a * 0.5f, a},
                           offset(10 * i + 8),
                           offset(10 * i + 9)});
    }
    std::ranges::sort(samples, {}, &Sample::z);
    return samples;
}

// A canvas with random pixels in [at, at + size), 0 elsewhere.
Ldi on_canvas(const Imath::V2i &at, std::uint32_t seed, const Imath::V2i &size = {90, 70}) {
    return make_ldi(windows_of_size(320, 224), rgba_channels(), [&](int x, int y) {
        const Imath::V2i p = Imath::V2i(x, y) - at;
        const bool inside = p.x >= 0 && p.y >= 0 && p.x < size.x && p.y < size.y;
        return inside ? random_pixel(p.x, p.y, seed) : std::vector<Sample>{};
    });
}

Ldi random_picture(std::uint32_t seed, int width = 80, int height = 60) {
    return make_ldi(windows_of_size(width, height), rgba_channels(),
                    [&](int x, int y) { return random_pixel(x, y, seed); });
}

// A random texture with lamps on a black ground, all at one depth: no blur, and no sharpening near focus, creates or
// loses light.
TEST(Invariants, EnergyIsKept) {
    for (const double c : {-9.0, -3.5, -1.2, -0.6, 0.7, 1.9, 4.2, 7.0}) {
        double before = 0;
        const Ldi ldi = make_ldi(windows_of_size(160, 120), rgba_channels(), [&](int x, int y) {
            const bool lit = x >= 40 && y >= 40 && x < 120 && y < 80;
            const double v = lit ? random_unit(x, y, 1) * (random_unit(x, y, 2) > 0.98 ? 50 : 1) : 0;
            before += double(float(v));
            return std::vector<Sample>{{depth_of(lens, c), {float(v), float(v / 2), float(v / 4), 1}}};
        });
        const Image image = gather(ldi);
        const double after = std::accumulate(image.plane(0).begin(), image.plane(0).end(), 0.0);
        EXPECT_NEAR(after / before, 1, 1e-4) << c;
    }
}

TEST(Invariants, OrderOfSamplesDoesNotMatter) {
    const Ldi ldi = random_picture(1);
    Ldi reversed = ldi;
    for (std::size_t pixel = 0; pixel + 1 < ldi.begin.size(); ++pixel) {
        const auto reverse = [&](std::vector<float> &values) {
            std::reverse(values.begin() + std::ptrdiff_t(ldi.pixel(pixel).from),
                         values.begin() + std::ptrdiff_t(ldi.pixel(pixel).to));
        };
        for (auto *values : {&reversed.z, &reversed.dx, &reversed.dy}) reverse(*values);
        for (auto &values : reversed.values) reverse(values);
    }
    EXPECT_NE(reversed.z, ldi.z);
    EXPECT_EQ(gather(tidy(reversed)).values, gather(tidy(ldi)).values);
}

TEST(Invariants, OrderOfViewsDoesNotMatter) {
    std::vector<View> views;
    for (std::uint32_t i = 0; i < 5; ++i) {
        const double angle = double(i);
        views.push_back(
            random_view(windows_of_size(48, 32),
                        i == 0 ? Imath::V2d(0, 0) : 0.06 * Imath::V2d(std::cos(angle), std::sin(angle)), i));
    }
    const auto picture = [&] {
        Progress silent;
        const Ldi ldi = warp(views, {.focal_px = 640, .radius = 0.06}, silent);
        return gather(tidy(ldi)).values;
    };
    const auto first = picture();
    std::rotate(views.begin() + 1, views.begin() + 3, views.end());
    EXPECT_EQ(picture(), first);
    std::swap(views[1], views[2]);
    EXPECT_EQ(picture(), first);
}

TEST(Invariants, ThreadsDoNotMatter) {
    const Ldi ldi = random_picture(2, 140, 100);
    const auto with = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return gather(ldi).values;
    };
    const auto one = with(1);
    for (const std::size_t threads : {2u, 3u, 7u}) EXPECT_EQ(with(threads), one) << threads;
}

// Without R, G, B: only lens points, without spread lamps and sharpening.
Ldi without_colour(Ldi ldi) {
    ldi.channels = {{"X"}, {"W"}, {"V"}, {"A"}};
    return ldi;
}

Image part(const Image &image, const Imath::V2i &at, const Imath::V2i &size) {
    Image cut = crop(image, {at, at + size - Imath::V2i(1)});
    cut.windows = windows_of_size(size.x, size.y);
    return cut;
}

// Away from the border: samples up to 64 pixels away decide which are highlights.
TEST(Invariants, MovedByWholeTilesItIsTheSamePicture) {
    const Imath::V2i margin(16), size = Imath::V2i(90, 70) + 2 * margin, at(52, 56);
    const Image expected = part(gather(on_canvas(at, 3)), at - margin, size);
    for (const Imath::V2i &by : {Imath::V2i(64, 0), {0, 64}, {128, 64}}) {
        const Image moved = part(gather(on_canvas(at + by, 3)), at + by - margin, size);
        EXPECT_EQ(largest_difference(moved, expected), 0) << by;
    }
}

// After a move by another distance samples fall into other blocks and tiles, which choose lens points, highlights and
// noise by their contents. With the same lens points, without lamps and sharpening, only rounding remains.
TEST(Invariants, MovedByWholePixelsItIsTheSamePictureToRounding) {
    const Imath::V2i margin(16), size = Imath::V2i(90, 70) + 2 * margin, at(20, 24);
    const Image expected = part(gather(without_colour(on_canvas(at, 3)), 64), at - margin, size);
    for (const Imath::V2i &by : {Imath::V2i(1, 0), {0, 1}, {37, 29}}) {
        const Image moved = part(gather(without_colour(on_canvas(at + by, 3)), 64), at + by - margin, size);
        EXPECT_LT(rms_difference(moved, expected), 1e-3) << by;
    }
}

Ldi mirrored(const Ldi &ldi) {
    return make_ldi(ldi.windows, ldi.channels, [&](int x, int y) {
        const std::size_t width = std::size_t(ldi.windows.width());
        const std::size_t pixel = std::size_t(y) * width + width - 1 - std::size_t(x);
        std::vector<Sample> samples;
        for (const std::uint64_t i : ldi.pixel(pixel)) {
            Sample s{double(ldi.z[i]), {}, -ldi.dx[i], ldi.dy[i]};
            for (const auto &values : ldi.values) s.values.push_back(values[i]);
            samples.push_back(s);
        }
        return samples;
    });
}

Image mirrored(const Image &image) {
    Image out = image;
    const int right = image.windows.data.max.x;
    for (std::size_t k = 0; k < image.channels.size(); ++k)
        for (int y = 0; y < image.windows.height(); ++y)
            for (int x = 0; x <= right; ++x) out.at(k, x, y) = image.at(k, right - x, y);
    return out;
}

// The lens is symmetric but its points are not: the remaining asymmetry falls with their error.
TEST(Invariants, AMirroredPictureIsMirrored) {
    const Ldi with_lamps = random_picture(4), without = without_colour(with_lamps);
    const auto asymmetry = [](const Ldi &ldi, int points) {
        return rms_difference(mirrored(gather(mirrored(ldi), points)), gather(ldi, points));
    };
    const double few = asymmetry(without, 64);
    EXPECT_LT(asymmetry(without, 256), 0.7 * few);
    EXPECT_LT(asymmetry(without, 1024), 0.5 * few);
    EXPECT_LT(asymmetry(with_lamps, 1024), 0.7 * asymmetry(with_lamps, 64));
}

// Lamps gain less, because each pixel of a disc asks one lens point whether it sees the lamp, for any number of lens
// points.
TEST(Invariants, FourTimesTheLensPointsAreCloserToTheTruth) {
    const Ldi ldi = without_colour(random_picture(5, 64, 60)); // nearly a tile
    const Image truth = gather(ldi, 16384);
    double last = rms_difference(gather(ldi, 16), truth);
    for (const int points : {64, 256, 1024}) {
        const double now = rms_difference(gather(ldi, points), truth);
        EXPECT_LT(now, 0.7 * last) << points;
        last = now;
    }
}

} // namespace
} // namespace sparselens
