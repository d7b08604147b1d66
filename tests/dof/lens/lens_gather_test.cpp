#include "deep/flatten.h"
#include "dof/lens/lens_gather.h"
#include "lens/lens_points.h"
#include "lens/psf.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace sparselens {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};        // CoC up to 7.7 px behind focus
const ThinLens far_focus{.radius = 0.06, .focal_px = 640, .focus = inf}; // the background is sharp
constexpr double rounding = 1e-5; // of sums over the lens points, in float
const std::vector<Channel> grey{{"Y"}}, grey_alpha{{"Y"}, {"A"}};

Image gather(const Ldi &ldi, const ThinLens &by, const LensGatherOptions &options = {}) {
    Progress silent;
    return lens_gather(ldi, by, ldi.windows.data, options, silent);
}

Image gather(const Ldi &ldi, const ThinLens &by, int lens_samples) {
    return gather(ldi, by, LensGatherOptions{.lens_samples = lens_samples});
}

double rms_difference(const Image &a, const Image &b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        sum += std::pow(double(a.values[i]) - double(b.values[i]), 2);
    return std::sqrt(sum / double(a.values.size()));
}

// The weights with which a pixel of a plane of CoC c shows the pixels around it, [(dx, dy)] to weight: squares
// displaced by the points of the disc, averaged over the pixel.
std::map<std::pair<int, int>, double> disc_of_squares(double c, double aspect) {
    constexpr int points = 20000;
    std::map<std::pair<int, int>, double> weights;
    for (const Imath::V2d &u : spiral_lens_points(points)) {
        const double x = c * u.x, y = -c * u.y * aspect;
        const int i = int(std::floor(x)), j = int(std::floor(y));
        const double s = x - i, t = y - j;
        weights[{i, j}] += (1 - s) * (1 - t) / points;
        weights[{i + 1, j}] += s * (1 - t) / points;
        weights[{i, j + 1}] += (1 - s) * t / points;
        weights[{i + 1, j + 1}] += s * t / points;
    }
    return weights;
}

double texture(int x, int y) { return random_unit(x, y, 1); }

// A random texture at one CoC, and its convolution.
struct Plane {
    Ldi ldi;
    ThinLens by = lens;
    Image expected;
    Imath::Box2i inner; // clear of the border

    Plane(double c, double aspect) {
        by.pixel_aspect = aspect;
        Windows windows = windows_of_size(84, 48);
        windows.pixel_aspect = float(aspect);
        ldi = make_ldi(windows, grey, [&](int x, int y) {
            return std::vector<Sample>{{depth_of(by, c), {float(texture(x, y))}}};
        });
        expected = Image(windows, grey);
        inner = {{12, 12}, {71, 35}};
        const auto weights = disc_of_squares(c, aspect);
        for (int y = inner.min.y; y <= inner.max.y; ++y)
            for (int x = inner.min.x; x <= inner.max.x; ++x)
                for (const auto &[d, weight] : weights)
                    expected.at(0, x, y) += float(weight * texture(x - d.first, y - d.second));
    }
    double rms_error(int lens_samples) const {
        return rms_difference(crop(gather(ldi, by, lens_samples), inner), crop(expected, inner));
    }
};

TEST(LensGather, PlanesAreConvolvedWithTheirDiscs) {
    for (const double aspect : {1.0, 1.6})
        for (const double c : {-5.3, -0.7, 2.9, 6.1}) {
            const Plane plane(c, aspect);
            const double error = plane.rms_error(256), finer = plane.rms_error(1024);
            EXPECT_LT(error, 0.02) << c;
            EXPECT_LT(finer, 0.7 * error) << c;
        }
}

// With light and dark rows, a lens shows in pixels twice as wide as high the same as at twice the CoC in square ones.
// The height is continuous in a focus pull: nothing stays sharp and then jumps.
TEST(LensGather, ADiscBlursAsSoonAsItIsHighEnough) {
    const auto column = [](double c, double aspect) {
        ThinLens by = lens;
        by.pixel_aspect = aspect;
        Windows windows = windows_of_size(16, 48);
        windows.pixel_aspect = float(aspect);
        const Image picture =
            gather(make_ldi(windows, grey,
                            [&](int, int y) {
                                return std::vector<Sample>{{depth_of(by, c), {y / 8 % 2 == 0 ? 0.0f : 1.0f}}};
                            }),
                   by);
        std::vector<float> values;
        for (int y = 8; y < 40; ++y) values.push_back(picture.at(0, 8, y));
        return values;
    };
    for (const double c : {0.2, 0.3, 0.4, 0.48, 0.52, 0.6}) {
        const std::vector<float> wide = column(c, 2), square = column(2 * c, 1);
        for (std::size_t y = 0; y < wide.size(); ++y) EXPECT_NEAR(wide[y], square[y], 0.02) << c << " " << y;
    }
}

// Through one point of the lens, a plane is displaced by its CoC and otherwise unchanged.
TEST(LensGatherThroughAPoint, PlanesAreMoved) {
    Plane plane(5, 1);
    const Image seen = gather(plane.ldi, plane.by, {.point = Imath::V2d(0.6, -0.8)});
    for (int y = 10; y < 40; ++y)
        for (int x = 10; x < 70; ++x) EXPECT_EQ(seen.at(0, x + 3, y + 4), float(texture(x, y)));
}

// Past the edge of a near half on the left, the filler behind it is marked, and everything else is unchanged.
TEST(LensGatherThroughAPoint, WhatNoViewSawIsMarked) {
    const Ldi ldi = make_ldi(windows_of_size(64, 16), rgba_channels(), [](int x, int) {
        return x < 32 ? std::vector<Sample>{{depth_of(lens, -4), {0.1f, 0.2f, 0.3f, 1}}}
                      : std::vector<Sample>{{depth_of(lens, 4), {0.4f, 0.6f, 0.8f, 1}}};
    });
    const auto row = [&](double u) { return gather(ldi, lens, {.point = Imath::V2d(u, 0)}); };
    const auto colour = [](const Image &image, int x) {
        return std::array{image.at(0, x, 8), image.at(1, x, 8), image.at(2, x, 8), image.at(3, x, 8)};
    };
    const std::array<float, 4> near{0.1f, 0.2f, 0.3f, 1}, far{0.4f, 0.6f, 0.8f, 1},
        marked{0.4f / 2 + 0.5f, 0.6f / 2, 0.8f / 2 + 0.5f, 1};
    const Image past = row(1); // the near half moves to the left, the far one to the right
    for (const int x : {20, 27}) EXPECT_EQ(colour(past, x), near) << x;
    for (const int x : {28, 31, 35}) EXPECT_EQ(colour(past, x), marked) << x;
    for (const int x : {36, 50}) EXPECT_EQ(colour(past, x), far) << x;
    const Image behind = row(-1);
    for (const int x : {20, 35}) EXPECT_EQ(colour(behind, x), near) << x;
    for (const int x : {36, 50}) EXPECT_EQ(colour(behind, x), far) << x;
}

// Tiles are reported from the given position outwards, each once, and with their final values.
TEST(LensGather, IsWatchedFromAPlaceOutwards) {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Ldi ldi = make_ldi(windows_of_size(300, 140), grey, [](int x, int y) {
        return std::vector<Sample>{{depth_of(lens, 3), {float(texture(x, y))}}};
    });
    std::vector<Imath::V2i> corners;
    Image told(ldi.windows, grey);
    const TileWatch watch{{150, 70}, [&](const Image &picture, const Imath::Box2i &tile) {
                              corners.push_back(tile.min);
                              for (int y = tile.min.y; y <= tile.max.y; ++y)
                                  for (int x = tile.min.x; x <= tile.max.x; ++x)
                                      told.at(0, x, y) = picture.at(0, x, y);
                          }};
    const Image picture = gather(ldi, lens, {.lens_samples = 8, .watch = &watch});
    EXPECT_EQ(told.values, picture.values);
    EXPECT_EQ(corners.front(), Imath::V2i(128, 64));
    ASSERT_EQ(corners.size(), 15u);
    EXPECT_EQ(picture.values, gather(ldi, lens, 8).values);
    for (std::size_t i = 1; i < corners.size(); ++i)
        EXPECT_LE((corners[i - 1] - Imath::V2i(118, 38)).length2(),
                  (corners[i] - Imath::V2i(118, 38)).length2());
}

TEST(LensGather, ConstantStaysConstantAndOpaque) {
    std::vector<Channel> channels = rgba_channels();
    channels.push_back({"extra.Y"});
    const Ldi ldi = make_ldi(windows_of_size(150, 70), channels, [](int x, int y) {
        const double c = -14 + 20 * random_unit(x / 9, y / 7, 1);
        return std::vector<Sample>{{depth_of(lens, c),
                                    {0.37f, 0.25f, 11, 1, 0.4f},
                                    float(random_unit(x, y, 2) - 0.5),
                                    float(random_unit(x, y, 3) - 0.5)}};
    });
    for (const Quality quality : {Quality::draft, Quality::normal}) {
        const Image image = gather(ldi, lens, LensGatherOptions{.quality = quality});
        const float expected[] = {0.37f, 0.25f, 11, 1, 0.4f};
        for (std::size_t k = 0; k < channels.size(); ++k)
            for (const float v : image.plane(k)) ASSERT_NEAR(v, expected[k], rounding * expected[k]);
    }
}

TEST(LensGather, LikeStacksGiveTheirComposite) {
    // The same samples in every pixel: however they are displaced, they show the same.
    const std::vector<Sample> stack{{depth_of(lens, -6), {0.1f, 0.3f}},
                                    {depth_of(lens, -5.4), {0.05f, 0.2f}},
                                    {depth_of(lens, -0.3), {0.4f, 0.5f}},
                                    {depth_of(lens, 3), {0.3f, 0.4f}}};
    const Ldi ldi = make_ldi(windows_of_size(60, 40), grey_alpha, [&](int, int) { return stack; });
    const Image image = gather(ldi, lens), flat = flatten(ldi);
    const Imath::Box2i inner({16, 16}, {43, 23});
    EXPECT_LT(largest_difference(crop(image, inner), crop(flat, inner)), 1e-5);
}

// Random stacks of coverage, light and ids, with a few lamps.
std::vector<Sample> random_stack(int x, int y, double z, float offset) {
    std::vector<Sample> samples;
    const int count = int(4 * random_unit(x, y, 1));
    for (int i = 0; i < count; ++i) {
        const auto random = [&](std::uint32_t k) {
            return float(random_unit(x, y, 100 * k + std::uint32_t(i)));
        };
        const float a = random(2) < 0.3f ? 1 : random(3), lamp = random(4) > 0.98f ? 100 : 1;
        samples.push_back(
            {z * (1 + 1e-7 * i),
             {a * lamp * random(5), a * random(6), a * random(7), a, std::bit_cast<float>(i + 1)},
             offset * (random(8) - 0.5f),
             offset * (random(9) - 0.5f)});
    }
    return samples;
}

TEST(LensGather, WithoutBlurIsTheFlattenedPicture) {
    std::vector<Channel> channels = rgba_channels();
    channels.push_back({"id", PixelType::uint32});
    // An almost closed lens: whatever the samples and their offsets, nothing moves.
    const Ldi apart = make_ldi(windows_of_size(90, 40), channels,
                               [](int x, int y) { return random_stack(x, y, 1 + x, 1); });
    EXPECT_LT(
        largest_difference(gather(apart, {.radius = 1e-9, .focal_px = 640, .focus = 5}), flatten(apart)),
        1e-5);
    // A real lens with everything in focus: light that passes to infinity cannot be blurred.
    const Ldi in_focus =
        make_ldi(windows_of_size(90, 40), channels, [](int x, int y) { return random_stack(x, y, 5, 0); });
    const Image image = gather(in_focus, lens), flat = flatten(in_focus);
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t i = 0; i < flat.windows.pixels(); ++i)
            ASSERT_NEAR(image.plane(k)[i], flat.plane(k)[i], 5e-4 * (1 + flat.plane(k)[i]));
}

TEST(LensGather, GoesOverIntoTheFlattenedPictureAsBlurGoesTo0) {
    // Partial samples at pixel centres, as in other renderers' deep files.
    const auto layers = [](double c) {
        return make_ldi(windows_of_size(70, 40), grey_alpha, [c](int x, int y) {
            std::vector<Sample> samples;
            for (int i = 0; i < 4; ++i) {
                const float a = i == 3 ? 1 : float(random_unit(x, y, 10 + std::uint32_t(i)));
                const double place = c * (-1 + 0.5 * i);
                samples.push_back(
                    {depth_of(lens, place), {a * float(random_unit(x, y, 20 + std::uint32_t(i))), a}});
            }
            return samples;
        });
    };
    double last = 0;
    for (const double c : {0.01, 0.1, 0.3, 0.49, 0.51, 0.7}) {
        const Ldi ldi = layers(c);
        const double difference = rms_difference(gather(ldi, lens, 1024), flatten(ldi));
        EXPECT_LT(difference, 0.5 * c);
        EXPECT_GE(difference, last);
        last = difference;
    }
}

// Half of the picture is covered, up to an edge at x = 32.
Ldi half_plane(const ThinLens &by, double c, double behind, float colour_behind) {
    return make_ldi(windows_of_size(64, 40), grey_alpha, [=](int x, int) {
        std::vector<Sample> samples;
        if (x < 32) samples.push_back({depth_of(by, c), {0.8f, 1}});
        if (behind != 0) samples.push_back({depth_of(by, behind), {colour_behind, 1}});
        return samples;
    });
}

// The share of a disc of radius r at x < e.
double share_before(double e, double r) {
    const double t = std::clamp(e / r, -1.0, 1.0);
    return 1 - (std::acos(t) - t * std::sqrt(1 - t * t)) / std::numbers::pi;
}

// The same for the disc averaged over a pixel.
double share_in_pixel(double e, double r) {
    double sum = 0;
    for (int i = 0; i < 100; ++i) sum += share_before(e + (i + 0.5) / 100 - 0.5, r) / 100;
    return sum;
}

TEST(LensGather, BlursCoverageAtAnEdgeBeforeNothing) {
    for (const double c : {-6.0, -2.5}) {
        const Image image = gather(half_plane(far_focus, c, 0, 0), far_focus, 1024);
        for (int x = 16; x < 48; ++x) {
            // The nothing beside the half plane continues behind it.
            const double share = share_in_pixel(32 - (x + 0.5), std::abs(c));
            ASSERT_NEAR(image.at(1, x, 20), share, 0.01) << x;
            ASSERT_NEAR(image.at(0, x, 20), 0.8 * share, 0.01) << x;
        }
    }
}

TEST(LensGather, SeesWhatLiesBehindABlurredEdge) {
    const Image image = gather(half_plane(lens, -6, 3, 0.1f), lens, 1024);
    for (int x = 16; x < 48; ++x) {
        const double share = share_in_pixel(32 - (x + 0.5), 6);
        ASSERT_NEAR(image.at(0, x, 20), 0.8 * share + 0.1 * (1 - share), 0.01) << x;
        ASSERT_EQ(image.at(1, x, 20), 1) << x;
    }
}

TEST(LensGather, ASharpEdgeStaysSharpBeforeWhatIsBlurred) {
    const Image image = gather(half_plane(lens, 0, 6, 0.1f), lens);
    for (int x = 8; x < 56; ++x) ASSERT_NEAR(image.at(0, x, 20), x < 32 ? 0.8 : 0.1, rounding) << x;
}

TEST(LensGather, UnknownIsLeftOut) {
    // Nothing is known behind the sharp strip: its neighbours are filled in there.
    const Ldi ldi = make_ldi(windows_of_size(64, 40), grey_alpha, [](int x, int) {
        return std::vector<Sample>{x >= 24 && x < 40 ? Sample{5, {0.8f, 1}}
                                                     : Sample{depth_of(lens, 6), {0.1f, 1}}};
    });
    const Image image = gather(ldi, lens);
    for (int x = 0; x < 64; ++x) {
        ASSERT_NEAR(image.at(0, x, 20), x >= 24 && x < 40 ? 0.8 : 0.1, rounding) << x;
        ASSERT_EQ(image.at(1, x, 20), 1) << x;
    }
}

TEST(LensGather, TransparentSamplesAtInfinityLieOverTheBackground) {
    const Ldi ldi = make_ldi(windows_of_size(70, 40), grey_alpha, [](int, int) {
        return std::vector<Sample>{{inf, {0.2f, 0.4f}, 0.25f, -0.25f}};
    });
    const Image image = gather(ldi, lens);
    EXPECT_NEAR(image.at(0, 35, 20), 0.2, 1e-5);
    EXPECT_NEAR(image.at(1, 35, 20), 0.4, 1e-5);
}

TEST(LensGather, IdsAreTheFrontSamplesAndNeverBlended) {
    std::vector<Channel> channels{{"Y"}, {"id", PixelType::uint32}};
    const Ldi ldi = make_ldi(windows_of_size(40, 30), channels, [](int x, int y) {
        const auto id = [](unsigned value) { return std::bit_cast<float>(value); };
        return std::vector<Sample>{{depth_of(lens, -6), {1, id(0x7f800000u + unsigned(x + 40 * y))}},
                                   {depth_of(lens, 2), {2, id(7)}}};
    });
    const Image image = gather(ldi, lens);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x)
            ASSERT_EQ(std::bit_cast<std::uint32_t>(image.at(1, x, y)), 0x7f800000u + unsigned(x + 40 * y));
    EXPECT_NEAR(image.at(0, 20, 15), 1, rounding);
}

TEST(LensGather, LayersAddUpToTheBeauty) {
    Ldi ldi = random_surfaces(windows_of_size(80, 50), lens, false, 3);
    ldi.channels = rgba_channels();
    ldi.values.resize(4);
    for (std::size_t k = 0; k < 3; ++k)
        for (const bool first : {true, false}) {
            ldi.channels.push_back({(first ? "first." : "second.") + ldi.channels[k].name});
            std::vector<float> values = ldi.values[k];
            for (std::size_t i = 0; i < values.size(); ++i) {
                const double share = random_unit(int(i), int(k), 5);
                values[i] *= float(first ? share : 1 - share);
            }
            ldi.values.push_back(values);
        }
    const Image image = gather(ldi, lens);
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < image.windows.pixels(); ++i) {
            const float beauty = image.plane(k)[i],
                        sum = image.plane(4 + 2 * k)[i] + image.plane(5 + 2 * k)[i];
            ASSERT_NEAR(sum, beauty, 1e-5f * (1 + std::abs(beauty)));
        }
}

TEST(LensGather, ALayerLikeTheBeautyComesOutLikeIt) {
    Ldi ldi = random_surfaces(windows_of_size(80, 50), lens, false, 4);
    ldi.values[4] = ldi.values[0];
    const Image image = gather(ldi, lens);
    for (std::size_t i = 0; i < image.windows.pixels(); ++i) ASSERT_EQ(image.plane(4)[i], image.plane(0)[i]);
}

// The same pixels under other coordinates.
Ldi moved(Ldi ldi, const Imath::V2i &by) {
    for (Imath::Box2i *box : {&ldi.windows.data, &ldi.windows.display}) box->min += by, box->max += by;
    return ldi;
}

TEST(LensGather, DoesNotDependOnWhereTheWindowLies) {
    const Ldi ldi = random_surfaces(windows_of_size(90, 70), lens, false, 5);
    const Image image = gather(ldi, lens), other = gather(moved(ldi, {-1000, 77}), lens);
    EXPECT_EQ(image.values, other.values);
    EXPECT_EQ(other.windows.data.min, Imath::V2i(-1000, 77));
}

TEST(LensGather, GivesAPartAsItGivesTheWhole) {
    // If no pixel lets light through, a window only selects what is written.
    const Ldi ldi = make_ldi(windows_of_size(150, 90), grey, [](int x, int y) {
        const double c = -5 + 10 * random_unit(x / 5, y / 5, 1);
        return std::vector<Sample>{{depth_of(lens, c), {float(texture(x, y))}}};
    });
    Progress silent;
    const Imath::Box2i part({64, 0}, {140, 63}); // at the corner of a tile: the same lens points see it
    EXPECT_EQ(lens_gather(ldi, lens, part, {}, silent).values, crop(gather(ldi, lens), part).values);
}

TEST(LensGather, IsTheSameWithAnyNumberOfThreads) {
    const Ldi ldi = random_surfaces(windows_of_size(150, 100), lens, false, 6);
    const auto with = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return gather(ldi, lens).values;
    };
    const auto one = with(1);
    EXPECT_EQ(one, with(2));
    EXPECT_EQ(one, with(3));
}

// Symmetric left to right and top to bottom, except for the lens points.
TEST(LensGather, TurnedLayersGiveTheTurnedPicture) {
    const ThinLens &by = lens;
    const auto layers = [&](bool turned) {
        return make_ldi(windows_of_size(70, 50), grey, [&](int x, int y) {
            const int i = turned ? 69 - x : x, j = turned ? 49 - y : y;
            std::vector<Sample> samples{{depth_of(by, 4), {float(texture(i, j))}}};
            if (random_unit(i / 4, j / 6, 2) < 0.3)
                samples.insert(samples.begin(),
                               {depth_of(by, -3), {float(1 + texture(i, j))}, turned ? -0.3f : 0.3f, 0});
            return samples;
        });
    };
    const Image image = gather(layers(false), by, 1024), turned = gather(layers(true), by, 1024);
    Image back = turned;
    std::ranges::reverse(back.plane(0));
    EXPECT_LT(rms_difference(back, image), 0.015);
    EXPECT_GT(rms_difference(turned, image), 0.1);
}

TEST(LensGather, OneSampleFarOutOfFocusHarmsNothing) {
    const auto layers = [](bool huge) {
        return make_ldi(windows_of_size(100, 70), rgba_channels(), [huge](int x, int y) {
            const float v = float(texture(x, y));
            std::vector<Sample> samples{{depth_of(lens, 2), {v, v, v, 1}}};
            if (huge && x == 50 && y == 30)
                samples.insert(samples.begin(), {1e-7, {1, 1, 1, 1}}); // CoC 4e8 px
            return samples;
        });
    };
    // Possibly other lens points, but the same picture.
    EXPECT_LT(rms_difference(gather(layers(true), lens), gather(layers(false), lens)), 0.03);
}

// Points of a lens that blurs by far more than the picture is wide see past it. If only a few saw anything, the blur
// would have the contrast of the texture.
TEST(LensGather, AWiderBlurHasNoMoreContrast) {
    const auto contrast = [](double c) {
        const Ldi wall = make_ldi(windows_of_size(84, 48), grey, [&](int x, int y) {
            return std::vector<Sample>{{depth_of(lens, c), {float(texture(x, y))}}};
        });
        const Image picture = gather(wall, lens);
        const auto [least, most] = std::ranges::minmax(picture.values);
        return most - least;
    };
    const float wide = contrast(-90);
    EXPECT_LT(wide, 0.15f);
    for (const double c : {-200.0, -5e3, -1e12}) EXPECT_LT(contrast(c), 1.1f * wide) << c;
}

TEST(LensGather, TakesTheSmallestPictures) {
    for (const std::size_t count : {0u, 1u, 3u}) {
        const Ldi one = make_ldi(windows_of_size(1, 1), rgba_channels(), [&](int, int) {
            return std::vector<Sample>(count, {depth_of(lens, -4), {0.25f, 0.5f, 1, 1}});
        });
        const Image image = gather(one, lens);
        const float expected[] = {0.25f, 0.5f, 1, 1};
        for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(image.at(k, 0, 0), count ? expected[k] : 0) << k;
    }
    const Ldi empty =
        make_ldi(windows_of_size(100, 3), rgba_channels(), [](int, int) { return std::vector<Sample>{}; });
    for (const float v : gather(empty, lens).values) EXPECT_EQ(v, 0);
    Ldi none;
    none.windows = windows_of_size(5, 5);
    none.begin.resize(26);
    EXPECT_TRUE(gather(none, lens).values.empty());
}

TEST(LensGather, TakesDepthsUpToInfinity) {
    for (const double focus : {5.0, inf}) {
        const Ldi ldi = make_ldi(windows_of_size(70, 40), grey_alpha, [](int x, int) {
            return std::vector<Sample>{{x < 35 ? inf : 1e30, {0.7f, 1}}};
        });
        const Image image = gather(ldi, {.radius = 0.06, .focal_px = 640, .focus = focus});
        for (const float v : image.plane(0)) ASSERT_NEAR(v, 0.7f, rounding);
    }
}

// Chosen by the CoC in pixels of the picture: 7 sub-pixels are 3.5 pixels of two.
TEST(LensGather, SubpixelsTakeThreeQuartersOfAPixelsPoints) {
    const Ldi ldi = make_ldi(windows_of_size(64, 64), grey_alpha, [](int, int) {
        return std::vector<Sample>{{depth_of(lens, 7), {0.7f, 1}}};
    });
    const auto points = [&](Quality quality, int across, int lens_samples) {
        LensTiles tiles;
        gather(ldi, lens,
               {.quality = quality, .lens_samples = lens_samples, .across = across, .chosen = &tiles});
        return tiles.lens_points.front();
    };
    EXPECT_EQ(points(Quality::final, 1, 0), 384);
    EXPECT_EQ(points(Quality::final, 2, 0), 216);
    EXPECT_EQ(points(Quality::final, 4, 0), 216);
    EXPECT_EQ(points(Quality::normal, 1, 0), 128);
    EXPECT_EQ(points(Quality::normal, 2, 0), 72);
    EXPECT_EQ(points(Quality::draft, 2, 0), 24);
    EXPECT_EQ(points(Quality::final, 2, 40), 40);
}

// The variance of a spread sample: c^2 / 4 for the disc, and 1/12 each for the sample's square and for the positions in
// a pixel from which lens points look; for sub-pixels, these positions span half the width. Sums of pixels reach it for
// samples anywhere in a pixel. Uses data channels, because light near the focus is sharpened. Half the width reduces it
// by .06; .01 is for positions and lens points not being quite independent.
TEST(LensGather, SubpixelsLookFromNearTheirMiddle) {
    std::vector<Channel> channels{{"N.X"}, {"A"}};
    find_kinds(channels);
    constexpr double coc = 2;
    constexpr int places = 8, middle = 8;
    for (const int across : {1, 2, 3}) {
        double sum = 0, square = 0;
        for (int place = 0; place < places; ++place) {
            const double dx = (place + 0.5) / places - 0.5;
            const Ldi ldi = make_ldi(windows_of_size(17, 17), channels, [&](int x, int y) {
                const bool lit = x == middle && y == middle;
                return std::vector<Sample>{{depth_of(lens, coc), {lit ? 1.0f : 0.0f, 1}, float(dx), 0}};
            });
            const Image image = gather(ldi, lens, {.lens_samples = 1024, .across = across});
            for (int y = 0; y < 17; ++y)
                for (int x = 0; x < 17; ++x) {
                    const double light = double(image.at(0, x, y)), far = x - middle - dx;
                    sum += light;
                    square += light * far * far;
                }
        }
        const double wide = across == 1 ? 1 : 0.5;
        EXPECT_NEAR(square / sum, coc * coc / 4 + 1.0 / 12 + wide * wide / 12, 0.02) << across;
    }
}

} // namespace
} // namespace sparselens
