#include "base/error.h"
#include "deep/flatten.h"
#include "dof/selective/selective.h"
#include "lens/psf.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace sparselens {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};
const ThinLens far_focus{.radius = 0.06, .focal_px = 640, .focus = inf}; // the background is sharp
const std::vector<Channel> grey{{"Y", PixelType::half}},
    grey_alpha{{"Y", PixelType::half}, {"A", PixelType::half}};

Image gather(const Ldi &ldi, const ThinLens &by, int layers = 8) {
    Progress progress;
    return selective_gather(ldi, by, {.layers = layers}, progress);
}

// Convolution of f with the disc of radius r at pixel (x, y).
template <typename F>
double convolve(const F &f, double r, double aspect, int x, int y) {
    const int reach = int(r * std::max(1.0, aspect)) + 2;
    double sum = 0;
    for (int b = y - reach; b <= y + reach; ++b)
        for (int a = x - reach; a <= x + reach; ++a)
            sum += f(a, b) * psf_weight({{a + 0.5, b + 0.5}, r, aspect}, x, y);
    return sum;
}

TEST(Selective, PlanesAreConvolvedWithTheirDiscs) {
    const auto texture = [](int x, int y) { return random_unit(x, y, 1); };
    for (const double aspect : {1.0, 1.6})
        for (const double c : {-5.3, -0.7, 0.0, 2.9, 6.1}) {
            ThinLens by = lens;
            by.pixel_aspect = aspect;
            Windows windows = windows_of_size(100, 60);
            windows.pixel_aspect = float(aspect);
            // Two planes side by side; compared away from the border between them.
            const Ldi ldi = make_ldi(windows, grey, [&](int x, int y) {
                return std::vector<Sample>{{depth_of(by, x < 50 ? c : -c), {float(texture(x, y))}}};
            });
            const Image image = gather(ldi, by);
            for (int y = 15; y < 45; ++y)
                for (int x = 15; x < 85; x += x == 35 ? 30 : 1)
                    ASSERT_NEAR(image.at(0, x, y), convolve(texture, std::abs(c), aspect, x, y), 1e-5)
                        << "c " << c << " at " << x << "," << y;
        }
}

TEST(Selective, ImagesAreBlurredByTheirOwnDepth) {
    const auto picture = [](double z, double image_z) {
        return gather(make_ldi(windows_of_size(60, 40), grey,
                               [&](int x, int y) {
                                   Sample s{depth_of(lens, z), {float(random_unit(x, y, 1))}};
                                   s.image_z = image_z == 0 ? 0 : depth_of(lens, image_z);
                                   return std::vector<Sample>{s};
                               }),
                      lens);
    };
    EXPECT_EQ(picture(-4, 3).values, picture(3, 0).values);
    EXPECT_NE(picture(-4, 3).values, picture(-4, 0).values);
}

TEST(Selective, ConstantStaysConstantAndOpaque) {
    const Ldi ldi = make_ldi(windows_of_size(70, 50), grey_alpha, [](int x, int y) {
        const double c = -14 + 20 * random_unit(x / 9, y / 7, 1);
        return std::vector<Sample>{{depth_of(lens, c),
                                    {0.37f, 1},
                                    float(random_unit(x, y, 2) - 0.5),
                                    float(random_unit(x, y, 3) - 0.5)}};
    });
    const Image image = gather(ldi, lens);
    for (const float y : image.plane(0)) ASSERT_NEAR(y, 0.37f, 1e-6);
    for (const float a : image.plane(1)) ASSERT_EQ(a, 1);
}

TEST(Selective, ConstantTransparencyStaysConstant) {
    const Ldi ldi = make_ldi(windows_of_size(60, 40), grey_alpha, [](int, int) {
        return std::vector<Sample>{{depth_of(lens, -3), {0.2f, 0.4f}}};
    });
    const Image image = gather(ldi, lens);
    for (const float y : image.plane(0)) ASSERT_NEAR(y, 0.2f, 1e-4);
    for (const float a : image.plane(1)) ASSERT_NEAR(a, 0.4f, 1e-4);
}

TEST(Selective, LikeStacksGiveTheirComposite) {
    // The same samples in every pixel, near each other and far apart: one layer or several, with the same result.
    const std::vector<Sample> stack{{depth_of(lens, -6), {0.1f, 0.3f}},
                                    {depth_of(lens, -5.4), {0.05f, 0.2f}},
                                    {depth_of(lens, -2), {0.4f, 0.5f}},
                                    {depth_of(lens, 3), {0.3f, 0.4f}}};
    const Ldi ldi = make_ldi(windows_of_size(40, 40), grey_alpha, [&](int, int) { return stack; });
    const Image image = gather(ldi, lens), flat = flatten(ldi);
    EXPECT_LT(largest_difference(image, flat), 1e-5);
}

TEST(Selective, SharpSamplesAreFlattened) {
    const Ldi ldi = make_ldi(windows_of_size(50, 30), grey_alpha, [](int x, int y) {
        std::vector<Sample> samples;
        for (int i = 0; i < 3; ++i) {
            const float a = random_unit(x, y, 10 + std::uint32_t(i)) < 0.3 ? 1 : 0.5f;
            samples.push_back({5 * (1 + 1e-5 * i), {a * float(random_unit(x, y, 20 + std::uint32_t(i))), a}});
        }
        return samples;
    });
    EXPECT_LT(largest_difference(gather(ldi, lens), flatten(ldi)), 1e-6);
}

// A lamp of radiance 1 in pixel (x, y) with CoC c, before a black plane in focus.
Ldi lamp_before_black(int size, const ThinLens &by, double c, Imath::V2i pixel, float dx, float dy) {
    Windows windows = windows_of_size(size, size);
    windows.pixel_aspect = float(by.pixel_aspect);
    return make_ldi(windows, grey, [=](int x, int y) {
        std::vector<Sample> samples{{by.focus, {0}}};
        if (Imath::V2i(x, y) == pixel) samples.insert(samples.begin(), Sample{depth_of(by, c), {1}, dx, dy});
        return samples;
    });
}

TEST(Selective, PointKeepsItsEnergyAndPlace) {
    for (const double c : {0.6, 1.0, 2.5, 9.7, 31.0, 100.0}) {
        const int size = 4 * int(c + 2) + 8; // so that no disc around a reached pixel leaves the picture
        const Imath::V2i pixel(size / 2 - 1, size / 2 + 1);
        const Image image = gather(lamp_before_black(size, lens, -c, pixel, 0.3f, -0.2f), lens);
        double sum = 0, x_mean = 0, y_mean = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const double v = image.at(0, x, y);
                sum += v;
                x_mean += v * (x + 0.5);
                y_mean += v * (y + 0.5);
                ASSERT_NEAR(v, psf_weight({{pixel.x + 0.8, pixel.y + 0.3}, c, 1}, x, y), 1e-6) << "c " << c;
            }
        EXPECT_NEAR(sum, 1, 1e-4) << "c " << c;
        EXPECT_NEAR(x_mean, pixel.x + 0.8, c < 2 ? 0.2 : 0.02);
        EXPECT_NEAR(y_mean, pixel.y + 0.3, c < 2 ? 0.2 : 0.02);
    }
}

TEST(Selective, PointBehindFocusSpreadsIntoItsNeighbours) {
    // In a plane at its own depth, c > 0: the weights come from sums of the neighbours' coverage.
    for (const double c : {0.1, 0.4, 1.3, 5.2}) {
        const Ldi ldi = make_ldi(windows_of_size(41, 41), grey, [=](int x, int y) {
            return std::vector<Sample>{{depth_of(lens, c), {x == 20 && y == 20 ? 1.0f : 0.0f}}};
        });
        const Image image = gather(ldi, lens);
        double sum = 0;
        for (const float v : image.plane(0)) sum += double(v);
        EXPECT_NEAR(sum, 1, 1e-4) << "c " << c;
    }
}

TEST(Selective, PixelAspectMakesEllipses) {
    ThinLens by = lens;
    by.pixel_aspect = 2;
    const Image image = gather(lamp_before_black(60, by, -8, {30, 30}, 0, 0), by);
    EXPECT_GT(image.at(0, 37, 30), 0);
    EXPECT_EQ(image.at(0, 39, 30), 0);
    EXPECT_GT(image.at(0, 30, 45), 0);
    EXPECT_EQ(image.at(0, 30, 47), 0);
    EXPECT_NEAR(image.at(0, 30, 33), 1 / (2 * 64 * std::numbers::pi), 1e-6);
}

TEST(Selective, MirroredInMirroredOut) {
    const Windows windows = windows_of_size(75, 33);
    const Ldi ldi = random_surfaces(windows, lens, false, 5);
    const auto mirrored = [&](bool horizontal) {
        return make_ldi(windows, ldi.channels, [&, horizontal](int x, int y) {
            const int from_x = horizontal ? 74 - x : x, from_y = horizontal ? y : 32 - y;
            const std::size_t pixel = std::size_t(from_y * 75 + from_x);
            std::vector<Sample> samples;
            for (const std::uint64_t i : ldi.pixel(pixel)) {
                Sample sample{double(ldi.z[i]), {}, ldi.dx[i], ldi.dy[i]};
                (horizontal ? sample.dx : sample.dy) *= -1;
                for (const auto &values : ldi.values) sample.values.push_back(values[i]);
                samples.push_back(sample);
            }
            return samples;
        });
    };
    const Image image = gather(ldi, lens), flipped = gather(mirrored(true), lens),
                flopped = gather(mirrored(false), lens);
    for (std::size_t channel = 0; channel < image.channels.size(); ++channel)
        for (int y = 0; y < 33; ++y)
            for (int x = 0; x < 75; ++x) {
                const float value = image.at(channel, x, y);
                ASSERT_NEAR(flipped.at(channel, 74 - x, y), value, 1e-5 * (1 + std::abs(value)));
                ASSERT_NEAR(flopped.at(channel, x, 32 - y), value, 1e-5 * (1 + std::abs(value)));
            }
}

TEST(Selective, BlurredOccluderLetsThroughWhatItDoesNotCover) {
    const auto in_strip = [](int x, int) { return x >= 30 && x < 34 ? 1.0 : 0.0; };
    const auto texture = [](int x, int y) { return random_unit(x, y, 4); };
    for (const bool known_behind : {true, false}) {
        // Where the area behind the strip is unseen, the plane has one colour, so that its neighbours can stand for it.
        const Ldi ldi = make_ldi(windows_of_size(64, 40), grey_alpha, [&](int x, int y) {
            std::vector<Sample> samples;
            if (in_strip(x, y) > 0) samples.push_back({depth_of(lens, -7), {2, 1}});
            if (known_behind || samples.empty())
                samples.push_back({5, {known_behind ? float(texture(x, y)) : 0.5f, 1}});
            return samples;
        });
        const Image image = gather(ldi, lens);
        for (int y = 10; y < 30; ++y)
            for (int x = 10; x < 54; ++x) {
                if (!known_behind && in_strip(x, y) > 0) { // nothing else is known there: the strip is opaque
                    ASSERT_NEAR(image.at(0, x, y), 2, 1e-5) << x << "," << y;
                    continue;
                }
                const double cover = convolve(in_strip, 7, 1, x, y),
                             behind = known_behind ? texture(x, y) : 0.5;
                ASSERT_NEAR(image.at(0, x, y), 2 * cover + (1 - cover) * behind, 1e-5) << x << "," << y;
                ASSERT_EQ(image.at(1, x, y), 1);
            }
    }
}

TEST(Selective, SharpOccluderStaysSharp) {
    // A strip in focus before a blurred plane with a lamp beside the strip.
    const Ldi ldi = make_ldi(windows_of_size(64, 40), grey, [&](int x, int y) {
        if (x >= 30 && x < 34) return std::vector<Sample>{{5, {0.25f}}};
        return std::vector<Sample>{{depth_of(lens, 5), {x == 36 && y == 20 ? 100.0f : 1.0f}}};
    });
    const Image image = gather(ldi, lens);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 64; ++x) {
            if (x >= 30 && x < 34) {
                ASSERT_EQ(image.at(0, x, y), 0.25f);
            } else {
                ASSERT_GE(image.at(0, x, y), 1 - 1e-5f); // without the strip's colour
            }
        }
    EXPECT_GT(image.at(0, 35, 20), 1.5f);
}

TEST(Selective, BlurredEdgeAgainstNothingHasItsAlpha) {
    const auto in_square = [](int x, int y) { return x >= 20 && x < 40 && y >= 15 && y < 30 ? 1.0 : 0.0; };
    const double c = -4;
    const Ldi ldi = make_ldi(windows_of_size(60, 45), grey_alpha, [&](int x, int y) {
        if (in_square(x, y) == 0) return std::vector<Sample>{};
        return std::vector<Sample>{{far_focus.radius * far_focus.focal_px / -c, {3, 1}}};
    });
    const Image image = gather(ldi, far_focus);
    for (int y = 0; y < 45; ++y)
        for (int x = 0; x < 60; ++x) {
            if (in_square(x, y) > 0) continue; // the area behind it is unseen
            const double cover = convolve(in_square, 4, 1, x, y);
            ASSERT_NEAR(image.at(1, x, y), cover, 1e-5);
            ASSERT_NEAR(image.at(0, x, y), 3 * cover, 1e-5);
        }
    EXPECT_EQ(image.at(1, 30, 22), 1);
    EXPECT_EQ(image.at(1, 2, 2), 0);
}

TEST(Selective, FewerLayersMixDepths) {
    const Ldi ldi = random_surfaces(windows_of_size(50, 40), lens, true, 3);
    const Image two = gather(ldi, lens, 2), three = gather(ldi, lens, 3), many = gather(ldi, lens, 32);
    EXPECT_GT(largest_difference(two, three), 0.05);
    EXPECT_GT(largest_difference(three, many), 0.05);
    EXPECT_THROW(gather(ldi, lens, 0), UsageError);
}

TEST(Selective, IdsAreTheFrontSamplesAndNeverBlended) {
    std::vector<Channel> channels{{"Y", PixelType::half}, {"id", PixelType::uint32}};
    const Ldi ldi = make_ldi(windows_of_size(30, 20), channels, [](int x, int y) {
        if (x == 3) return std::vector<Sample>{};
        const auto id = [](unsigned value) { return std::bit_cast<float>(value); };
        return std::vector<Sample>{{depth_of(lens, -6), {1, id(0x7f800000u + unsigned(x + 30 * y))}},
                                   {depth_of(lens, 2), {2, id(7)}}};
    });
    const Image image = gather(ldi, lens);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 30; ++x)
            ASSERT_EQ(std::bit_cast<unsigned>(image.at(1, x, y)),
                      x == 3 ? 0 : 0x7f800000u + unsigned(x + 30 * y));
}

TEST(Selective, SameBitsWithAnyNumberOfThreads) {
    const Ldi ldi = random_surfaces(windows_of_size(150, 140), lens, false, 9);
    const auto with_threads = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return gather(ldi, lens).values;
    };
    const auto one = with_threads(1);
    EXPECT_EQ(one, with_threads(2));
    EXPECT_EQ(one, with_threads(7));
}

TEST(Selective, TinyAndOddPictures) {
    const Image pixel = gather(make_ldi(windows_of_size(1, 1), grey_alpha,
                                        [](int, int) {
                                            return std::vector<Sample>{{depth_of(lens, -9), {0.5f, 1}}};
                                        }),
                               lens);
    EXPECT_FLOAT_EQ(pixel.at(0, 0, 0), 0.5f);
    EXPECT_EQ(pixel.at(1, 0, 0), 1);
    const Image empty = gather(
        make_ldi(windows_of_size(3, 2), grey_alpha, [](int, int) { return std::vector<Sample>{}; }), lens);
    for (const float value : empty.values) EXPECT_EQ(value, 0);
    // 200 samples in one pixel, and none in the next.
    const Image stacked = gather(make_ldi(windows_of_size(2, 1), grey_alpha,
                                          [](int x, int) {
                                              std::vector<Sample> samples;
                                              for (int i = 0; x == 0 && i < 200; ++i)
                                                  samples.push_back({2.0 + 0.1 * i, {0.005f, 0.01f}});
                                              return samples;
                                          }),
                                 lens);
    for (const float value : stacked.values) EXPECT_TRUE(std::isfinite(value) && value >= 0 && value <= 1);
}

TEST(Selective, WindowsAreKept) {
    Windows windows;
    windows.display = {{0, 0}, {39, 29}};
    windows.data = {{-13, -7}, {22, 18}};
    windows.pixel_aspect = 1;
    const Ldi there = random_surfaces(windows, lens, false, 6);
    const Image image = gather(there, lens);
    EXPECT_EQ(image.windows, windows);
    EXPECT_EQ(image.channels, there.channels);
    Ldi at_origin = there;
    at_origin.windows = windows_of_size(36, 26);
    EXPECT_LT(largest_difference(gather(at_origin, lens), image), 1e-5);
}

TEST(Selective, HugeBlurIsTheMeanAndQuick) {
    // All discs are larger than the picture, so every pixel is the mean of all.
    const ThinLens wide{.radius = 100, .focal_px = 640, .focus = 5};
    double mean = 0;
    const Ldi ldi = make_ldi(windows_of_size(200, 150), grey, [&](int x, int y) {
        const double value = random_unit(x, y, 1);
        mean += value / (200 * 150);
        return std::vector<Sample>{{2.8, {float(value)}}};
    });
    EXPECT_NEAR(circle_of_confusion(wide, 2.8), -1e4, 100);
    const Image image = gather(ldi, wide);
    for (const float value : image.plane(0)) ASSERT_NEAR(value, mean, 1e-6);
}

TEST(Selective, SkyAndFocusAtInfinity) {
    const Ldi ldi = make_ldi(windows_of_size(30, 20), grey_alpha, [](int x, int) {
        return std::vector<Sample>{{x < 15 ? inf : 4.0, {0.5f, 1}}};
    });
    for (const ThinLens &by : {lens, far_focus}) {
        const Image image = gather(ldi, by);
        for (const float value : image.plane(0)) ASSERT_NEAR(value, 0.5, 1e-6);
        for (const float value : image.plane(1)) ASSERT_EQ(value, 1);
    }
}

} // namespace
} // namespace sparselens
