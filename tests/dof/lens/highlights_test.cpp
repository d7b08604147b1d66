#include "dof/lens/blocked_fixture.h"
#include "dof/lens/highlights.h"
#include "dof/lens/lens_gather.h"
#include "lens/lamp_spread.h"
#include "lens/psf.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace sparselens {
namespace {

const ThinLens wide{.radius = 1.2, .focal_px = 640, .focus = 5}; // CoC up to 153 px behind focus
constexpr std::size_t red_channel = 0, alpha = 3;

struct Blocked : BlockedLdi {
    using BlockedLdi::BlockedLdi;
    Highlights take() {
        const std::size_t brightness[] = {0, 1, 2};
        return take_highlights(samples, brightness, brightness, colours);
    }
};

// A plane of CoC c, of a random brightness from 1/2 to 1, on which some pixels shine.
Ldi shining_plane(int size, const ThinLens &lens, double c, const std::function<float(int x, int y)> &shine) {
    Windows windows = windows_of_size(size, size);
    windows.pixel_aspect = float(lens.pixel_aspect);
    return make_ldi(windows, rgba_channels(), [&](int x, int y) {
        const float v = shine(x, y) + float(0.5 + 0.5 * random_unit(x, y, 1));
        return std::vector<Sample>{{depth_of(lens, c), {v, v / 2, v / 4, 1}}};
    });
}

TEST(TakeHighlights, TakesTheLightThatStandsOutAndLeavesTheRest) {
    const auto shine = [](int x, int y) { return x == 11 && y == 40 ? 60.0f : 0.0f; };
    for (const double c : {2.5, -20.0}) {
        Blocked blocked(shining_plane(48, wide, c, shine), wide);
        const SampleColours before = blocked.colours;
        const Highlights highlights = blocked.take();
        ASSERT_EQ(highlights.sample.size(), 1u);
        const std::uint32_t lamp = highlights.sample[0];
        EXPECT_EQ(blocked.samples.x[lamp], 11.5f);
        EXPECT_EQ(blocked.samples.y[lamp], 40.5f);
        EXPECT_GE(blocked.colours.at(red_channel, lamp), 0.5f);
        EXPECT_LE(blocked.colours.at(red_channel, lamp), 1);
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_FLOAT_EQ(highlights.light.at(k, 0) + blocked.colours.at(k, lamp), before.at(k, lamp));
        EXPECT_EQ(highlights.light.at(alpha, 0), 0);
        EXPECT_EQ(blocked.colours.at(alpha, lamp), 1);
        for (std::size_t i = 0; i < blocked.samples.count(); ++i)
            for (std::size_t k = 0; k < 4 && i != lamp; ++k)
                ASSERT_EQ(blocked.colours.at(k, i), before.at(k, i));
    }
}

TEST(TakeHighlights, TakesNothingNearFocusNorWhatIsNoBrighterThanOther) {
    const auto lamp = [](int x, int y) { return x == 11 && y == 40 ? 60.0f : 0.0f; };
    EXPECT_TRUE(Blocked(shining_plane(48, wide, 1.5, lamp), wide).take().sample.empty());
    const auto bright_half = [](int x, int) { return x < 24 ? 60.0f : 0.0f; };
    EXPECT_TRUE(Blocked(shining_plane(48, wide, 9, bright_half), wide).take().sample.empty());
    const auto nothing = [](int, int) { return 0.0f; };
    EXPECT_TRUE(Blocked(shining_plane(48, wide, 9, nothing), wide).take().sample.empty());
}

// Their number is bounded however the light is spread: each costs the area of its disc.
TEST(TakeHighlights, AreFew) {
    const auto sparks = [](int x, int y) {
        const double r = random_unit(x, y, 2);
        return r < 0.2 ? float(std::pow(10, 30 * r)) : 0.0f;
    };
    const Highlights highlights = Blocked(shining_plane(96, wide, 9, sparks), wide).take();
    EXPECT_LE(highlights.sample.size(), 96u * 96u / 32);
    EXPECT_TRUE(std::ranges::is_sorted(highlights.sample));
}

TEST(NearestLensPoint, IsThePointItselfAndNearForAnyPlace) {
    for (const double aspect : {1.0, 2.0})
        for (const std::size_t n : {1u, 5u, 64u, 256u}) {
            const auto lens = disc_lens_samples(n, aspect);
            const NearestLensPoint nearest(lens);
            for (std::uint32_t k = 0; k < n; ++k) EXPECT_EQ(nearest(lens[k].x, lens[k].y), k) << n;
            const auto distance = [&](std::uint32_t k, float x, float y) {
                return std::hypot(lens[k].x - x, lens[k].y - y);
            };
            EXPECT_LT(nearest(1e9f, -1e9f), n);
            for (int i = 0; i < 300 && n >= 64;
                 ++i) { // fewer do not reach the rim, and places beyond count as there
                const double r = 0.95 * std::sqrt(random_unit(i, 0, 1)), angle = 7 * random_unit(i, 1, 1);
                const float x = float(r * std::cos(angle)), y = float(aspect * r * std::sin(angle));
                float least = INFINITY;
                for (std::uint32_t k = 0; k < n; ++k) least = std::min(least, distance(k, x, y));
                EXPECT_LE(distance(nearest(x, y), x, y), least + 0.03f * float(aspect)) << n;
            }
        }
}

TEST(HighlightPixels, AreThePsfSeenThroughTheNearestLensPoints) {
    for (const double aspect : {1.0, 1.6}) {
        ThinLens lens = wide;
        lens.pixel_aspect = aspect;
        const auto lamps = [](int x, int y) {
            return (x == 30 && y == 30) || (x == 65 && y == 60) ? 50.0f : 0.0f;
        };
        for (const double c : {-13.4, 2.7}) {
            Blocked blocked(shining_plane(96, lens, c, lamps), lens);
            const Highlights highlights = blocked.take();
            ASSERT_EQ(highlights.sample.size(), 2u);
            const auto points = disc_lens_samples(64, aspect);
            const NearestLensPoint nearest(points);
            const Aperture aperture;
            const CatEye no_cut(aperture, {}, {});
            double sums[2] = {};
            for (const Imath::V2i &origin :
                 {Imath::V2i(0, 0), Imath::V2i(48, 0), Imath::V2i(0, 48), Imath::V2i(48, 48)}) {
                std::uint32_t last = 0;
                for (const HighlightPixel &p : highlight_pixels(highlights, blocked.samples, nearest,
                                                                {aperture, no_cut}, aspect, origin, 48)) {
                    EXPECT_GE(p.lens, last);
                    last = p.lens;
                    ASSERT_LT(std::max(p.x, p.y), 48);
                    ASSERT_EQ(p.of, all_colours);
                    const std::uint32_t s = highlights.sample[p.highlight];
                    const int x = origin.x + p.x, y = origin.y + p.y;
                    const Imath::V2d centre(double(blocked.samples.x[s]), double(blocked.samples.y[s]));
                    ASSERT_NEAR(p.weight, psf_weight({centre, std::abs(c), aspect}, x, y), 1e-6);
                    ASSERT_EQ(p.lens,
                              nearest(float((x + 0.5 - centre.x) / c), float((y + 0.5 - centre.y) / c)));
                    sums[p.highlight] += double(p.weight);
                }
            }
            for (const double sum : sums) EXPECT_NEAR(sum, 1, 1e-4);
        }
    }
}

// In the picture.

Image gather(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks = {}) {
    Progress silent;
    return lens_gather(ldi, lens, ldi.windows.data, {.looks = looks}, silent);
}

struct PixelLamp {
    Imath::V2i pixel;
    float dx = 0, dy = 0;
    double coc = 0;
    Imath::V2d place() const { return {pixel.x + 0.5 + double(dx), pixel.y + 0.5 + double(dy)}; }
};

// One lamp of radiance 1000 before nothing.
Ldi lamp_alone(int size, const ThinLens &lens, const PixelLamp &lamp) {
    Windows windows = windows_of_size(size, size);
    windows.pixel_aspect = float(lens.pixel_aspect);
    return make_ldi(windows, rgba_channels(), [&](int x, int y) {
        std::vector<Sample> samples;
        if (Imath::V2i(x, y) == lamp.pixel)
            samples.push_back({depth_of(lens, lamp.coc), {1000, 500, 250, 1}, lamp.dx, lamp.dy});
        return samples;
    });
}

TEST(LensGatherOfAPoint, KeepsItsEnergyPlaceAndShape) {
    for (const double aspect : {1.0, 1.5})
        for (const double c : {3.0, -9.7, 31.0, -100.0}) {
            if (aspect > 1 && std::abs(c) > 50) continue;
            ThinLens lens = wide;
            lens.pixel_aspect = aspect;
            const int size = 2 * int(std::abs(c) * aspect) + 12;
            const PixelLamp lamp{{size / 2, size / 2 + 1}, 0.3f, -0.2f, c};
            const Image image = gather(lamp_alone(size, lens, lamp), lens);
            Imath::V2d centroid(0, 0);
            double sum = 0, worst = 0;
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) {
                    const double v = double(image.at(red_channel, x, y));
                    sum += v;
                    centroid += v * Imath::V2d(x + 0.5, y + 0.5);
                    worst = std::max(
                        worst, std::abs(v - 1000 * psf_weight({lamp.place(), std::abs(c), aspect}, x, y)));
                }
            EXPECT_NEAR(sum, 1000, 1) << c;
            EXPECT_LT((centroid / sum - lamp.place()).length(), 0.01) << c;
            EXPECT_LT(worst, 1e-3 * 1000 / (3 * c * c * aspect)) << c;
        }
}

std::shared_ptr<const AperturePicture> coloured_halves() {
    // The left half is red and the right half is green; blue passes everywhere.
    return std::make_shared<AperturePicture>(AperturePicture{2, 1, {1, 0, 1, 0, 1, 1}});
}

TEST(LensGatherOfAPoint, IsThePictureOfTheAperture) {
    for (const ApertureShape &shape :
         {ApertureShape{.blades = 5, .rotation = 20}, ApertureShape{.blades = 3, .curvature = 0.5},
          ApertureShape{.squeeze = 2}, ApertureShape{.squeeze = 0.5}, ApertureShape{.spherical = 0.9},
          ApertureShape{.blades = 6, .spherical = -0.5}, ApertureShape{.picture = coloured_halves()}})
        for (const double c : {9.3, -13.7}) {
            const int size = 2 * int(std::abs(c) / std::min(1.0, shape.squeeze)) + 12;
            const PixelLamp lamp{{size / 2, size / 2 + 1}, 0.3f, -0.2f, c};
            const Image image = gather(lamp_alone(size, wide, lamp), wide, {.aperture = shape});
            // A disc has no spread of its own: blades that are round, and weigh the same.
            ApertureShape described = shape;
            if (Aperture(shape).disc()) described.spherical = 1e-12;
            const LampSpread spread =
                spread_lamp(Aperture(described), {lamp.place(), c}, {{0, 0}, {size - 1, size - 1}});
            double sum = 0, worst = 0;
            std::size_t i = 0;
            for (int y = spread.box.min.y; y <= spread.box.max.y; ++y)
                for (int x = spread.box.min.x; x <= spread.box.max.x; ++x, ++i) {
                    const double weight = spread.coloured ? spread.colours[i][0] : spread.weights[i];
                    sum += double(image.at(red_channel, x, y));
                    worst = std::max(worst, std::abs(double(image.at(red_channel, x, y)) - 1000 * weight));
                }
            EXPECT_NEAR(sum, 1000, 1) << c;
            EXPECT_LT(worst, 1e-3 * 1000 / (c * c / shape.squeeze)) << c;
        }
}

TEST(LensGatherOfAPoint, HasColouredHalvesMirroredInFrontOfFocus) {
    for (const double c : {20.0, -20.0}) {
        const PixelLamp lamp{{30, 30}, 0, 0, c};
        const Image image =
            gather(lamp_alone(60, wide, lamp), wide, {.aperture = {.picture = coloured_halves()}});
        const int reddish = c > 0 ? 20 : 40, greenish = 60 - reddish;
        EXPECT_GT(image.at(0, reddish, 30), 0.1f);
        EXPECT_LT(image.at(1, reddish, 30), 1e-3f);
        EXPECT_LT(image.at(0, greenish, 30), 1e-3f);
        EXPECT_GT(image.at(1, greenish, 30), 0.1f);
    }
}

// An edge through the lamp's place hides one half of its disc, the one that follows from x = p + c u.
TEST(LensGatherOfAPoint, IsHiddenWhereTheLensPointDoesNotSeeIt) {
    struct Half {
        double coc, coc_before; // of the lamp; of what covers x > the lamp's x in the centre view
        bool left_shines;
    };
    // In focus it hides what lies there; nearer than a lamp that is itself before focus, it moves across it.
    for (const Half &half : {Half{20, 0, true}, Half{-10, -20, false}, Half{-20, -30, false}}) {
        // By name: clang 14 lets no lambda capture a structured binding.
        const double coc = half.coc, coc_before = half.coc_before;
        const bool left_shines = half.left_shines;
        const int size = 80;
        const PixelLamp lamp{{39, 40}, 0.5f, 0, coc};
        const Ldi ldi = make_ldi(windows_of_size(size, size), rgba_channels(), [&](int x, int y) {
            std::vector<Sample> samples;
            if (x >= 40) samples.push_back({depth_of(wide, coc_before), {0, 0, 0, 1}});
            if (Imath::V2i(x, y) == lamp.pixel)
                samples.push_back({depth_of(wide, coc), {1000, 500, 250, 1}, lamp.dx, lamp.dy});
            return samples;
        });
        const Image image = gather(ldi, wide);
        double left = 0, right = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) (x < 40 ? left : right) += double(image.at(red_channel, x, y));
        EXPECT_NEAR(left_shines ? left : right, 500, 30) << coc; // to within the lens points' distance
        EXPECT_LT(left_shines ? right : left, 30) << coc;
    }
}

} // namespace
} // namespace sparselens
