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
#include <numbers>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {
namespace {

const ThinLens wide{.radius = 1.2, .focal_px = 640, .focus = 5}; // CoC up to 153 px behind focus
constexpr std::size_t red_channel = 0, alpha = 3;

struct Blocked : BlockedLdi {
    using BlockedLdi::BlockedLdi;
    Highlights take(const std::optional<PositionBox> &seen = {}) {
        return take_highlights(ldi, samples, colours, seen);
    }
};

// A plane of CoC c with random brightness from 1/2 to 1, and some shining pixels.
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
    for (const double c : {0.0, 1.5, -20.0}) {
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

TEST(TakeHighlights, LeavesADiscThatIsTooWideToBeSeen) {
    const auto share = [](double c, float shines) {
        const auto shine = [&](int x, int y) { return x == 11 && y == 40 ? shines : 0.0f; };
        const std::vector<float> shares = Blocked(shining_plane(48, wide, c, shine), wide).take().share;
        EXPECT_LE(shares.size(), 1u);
        return shares.empty() ? 0 : shares[0];
    };
    EXPECT_GT(share(20, 6), 0.8f);
    EXPECT_EQ(share(150, 6), 0);
    EXPECT_GT(share(150, 60), 0.9f);
    const float hardly = share(150, 8.5f), more = share(150, 9.5f); // between, so that nothing pops
    EXPECT_GT(hardly, 0);
    EXPECT_GT(more, hardly + 0.1f);
    EXPECT_LT(more, 0.9f);
}

TEST(TakeHighlights, ThinLayersDoNotOutvoteTheSurfaceBehindThem) {
    const auto behind_layers = [](int layers) {
        return make_ldi(windows_of_size(64, 64), rgba_channels(), [&](int x, int y) {
            std::vector<Sample> samples;
            for (int n = 0; n < layers; ++n) {
                const float covers = 0.5f / float(layers);
                samples.push_back({depth_of(wide, -9 + 8.0 * n / layers), {covers / 10, 0, 0, covers}});
            }
            const float v = (x == 11 && y == 40 ? 60.0f : 0.0f) + float(0.5 + 0.5 * random_unit(x, y, 1));
            samples.push_back({depth_of(wide, 9), {v, v, v, 1}});
            return samples;
        });
    };
    for (const int layers : {1, 20}) {
        const Ldi ldi = behind_layers(layers);
        Blocked blocked(ldi, wide);
        const Highlights highlights = blocked.take();
        ASSERT_EQ(highlights.sample.size(), 1u) << layers;
        EXPECT_EQ(blocked.samples.x[highlights.sample[0]], 11.5f);
    }
}

// Bright and noisy mist in front of a lamp: the lamp alone is one, whatever the mist does to what is around it.
TEST(TakeHighlights, VolumesAreNeitherLampsNorAroundThem) {
    const auto behind_mist = [](float thickness, float brightness) {
        return make_ldi(windows_of_size(64, 64), rgba_channels(), [&](int x, int y) {
            const float noise = random_unit(x, y, 2) < 0.05 ? 40 * brightness : brightness;
            const double z = depth_of(wide, -9);
            Sample mist{z, {noise, noise, noise, 0.2f}};
            mist.z_back = float(z) + thickness;
            const float v = (x == 11 && y == 40 ? 60.0f : 0.0f) + float(0.5 + 0.5 * random_unit(x, y, 1));
            return std::vector<Sample>{mist, {depth_of(wide, 9), {v, v, v, 1}}};
        });
    };
    const auto taken = [&](float thickness, float brightness) {
        Blocked blocked(behind_mist(thickness, brightness), wide);
        return blocked.take().share;
    };
    const std::vector<float> alone = taken(1, 0);
    ASSERT_EQ(alone.size(), 1u);
    EXPECT_EQ(taken(1, 1), alone);
    EXPECT_EQ(taken(1, 100), alone);
    EXPECT_GT(taken(0, 1).size(), 10u); // points of the same light are lamps
}

// A sample that covers n times as much counts like n samples.
TEST(Surroundings, CountByWhatIsCovered) {
    for (const int count : {0, 1, 2, 5, 10, 11, 64}) {
        std::vector<CoveredLight> covered, one_each;
        std::vector<float> each;
        for (int i = 0; i < count; ++i) {
            const auto brightness = float(random_unit(i, count, 1));
            const int times = 1 + int(3 * random_unit(i, count, 2));
            covered.push_back({brightness, float(times) / 4});
            for (int n = 0; n < times; ++n) {
                each.push_back(brightness);
                one_each.push_back({brightness, 1});
            }
        }
        const float expected = surroundings_of(std::span(each), 5);
        EXPECT_EQ(surroundings_of(std::span(covered), 5), expected) << count;
        EXPECT_EQ(surroundings_of(std::span(one_each), 5), expected) << count;
    }
}

// Four fifths of the picture are dark but unseen, so the shining pixels beside them do not stand out.
TEST(TakeHighlights, AsksOnlyWhatWasSeenForWhatIsAround) {
    const Ldi ldi = shining_plane(64, wide, 20, [](int x, int y) {
        const bool bright = x < 12 && (x + y) % 3 == 0;
        return x == 5 && y == 40 ? 60.0f : bright ? 0.0f : 0.01f - float(0.5 + 0.5 * random_unit(x, y, 1));
    });
    EXPECT_GT(Blocked(ldi, wide).take().sample.size(), 240u);
    Blocked blocked(ldi, wide);
    const Highlights highlights = blocked.take(PositionBox{Position(0, 0), Position(11, 63)});
    ASSERT_EQ(highlights.sample.size(), 1u);
    EXPECT_EQ(blocked.samples.x[highlights.sample[0]], 5.5f);
    // Where nothing was seen, all the existing samples are asked.
    EXPECT_GT(Blocked(ldi, wide).take(PositionBox{Position(-9, 0), Position(-1, 63)}).sample.size(), 240u);
}

// Only the dark part was seen. The made-up part beside it is bright all over, and only its lamp stands out of it.
TEST(TakeHighlights, AsksWhatIsMadeUpToStandOutOfItself) {
    const Ldi ldi = shining_plane(64, wide, 20, [](int x, int y) {
        return x < 12 ? 0.01f - float(0.5 + 0.5 * random_unit(x, y, 1)) : x == 40 && y == 40 ? 60.0f : 0.0f;
    });
    Blocked blocked(ldi, wide);
    const Highlights highlights = blocked.take(PositionBox{Position(0, 0), Position(11, 63)});
    ASSERT_EQ(highlights.sample.size(), 1u);
    EXPECT_EQ(blocked.samples.x[highlights.sample[0]], 40.5f);
}

TEST(TakeHighlights, TakesNothingThatIsNoBrighterThanOther) {
    const auto bright_half = [](int x, int) { return x < 24 ? 60.0f : 0.0f; };
    EXPECT_TRUE(Blocked(shining_plane(48, wide, 9, bright_half), wide).take().sample.empty());
    const auto nothing = [](int, int) { return 0.0f; };
    EXPECT_TRUE(Blocked(shining_plane(48, wide, 9, nothing), wide).take().sample.empty());
}

// A bar of a fifth of the picture. Its brightness is common around it, but it stands out of the empty part.
TEST(TakeHighlights, TakesAllOfAThinElementOverNothing) {
    const Ldi ldi = make_ldi(windows_of_size(64, 64), rgba_channels(), [](int x, int y) {
        const float v = float(0.5 + 0.5 * random_unit(x, y, 1));
        return x < 12 ? std::vector<Sample>{{depth_of(wide, 9), {v, v, v, 1}}} : std::vector<Sample>{};
    });
    Blocked blocked(ldi, wide);
    const Highlights highlights = blocked.take();
    ASSERT_EQ(highlights.sample.size(), 12u * 64);
    for (const std::uint32_t i : highlights.sample) ASSERT_EQ(blocked.colours.at(red_channel, i), 0);
}

// As a sample becomes brighter, more and more of it is spread, without a step where it becomes a highlight.
TEST(TakeHighlights, BeginsWithNothing) {
    float last = 0;
    for (float brightness = 2; brightness < 8; brightness += 0.05f) {
        const auto shine = [&](int x, int y) { return x == 11 && y == 40 ? brightness : 0.0f; };
        const Highlights highlights = Blocked(shining_plane(48, wide, 9, shine), wide).take();
        const float spread = highlights.sample.empty() ? 0 : highlights.light.at(red_channel, 0);
        ASSERT_GE(spread, last - 1e-5f);
        ASSERT_LE(spread, last + 0.25f) << brightness; // a step would be three quarters of it
        last = spread;
    }
    EXPECT_GT(last, 6);
}

TEST(TakeHighlights, TakesAWholeLampOfSixteenPixels) {
    const auto shine = [](int x, int y) { return x >= 60 && x < 76 && y >= 8 && y < 24 ? 60.0f : 0.0f; };
    EXPECT_EQ(Blocked(shining_plane(96, wide, 9, shine), wide).take().sample.size(), 256u);
}

// Their number is bounded for any number of shining samples, because each costs the area of its disc: one sample in
// five (highlights.h). Here two in five shine, by ten to the power of 30 r for r up to 0.4. Four of five samples stay
// below r = 0.2, and four times that is r = 0.2 + log10(4) / 30: 18 % stand out. Windows of 1024 samples measure their
// level to 0.013.
TEST(TakeHighlights, AreAtMostOneSampleInFive) {
    const auto sparks = [](int x, int y) {
        const double r = random_unit(x, y, 2);
        return r < 0.4 ? float(std::pow(10, 30 * r)) : 0.0f;
    };
    const Highlights highlights = Blocked(shining_plane(96, wide, 9, sparks), wide).take();
    EXPECT_LE(highlights.sample.size(), 96u * 96u / 5);
    EXPECT_NEAR(double(highlights.sample.size()) / (96 * 96), 0.18, 0.02);
    EXPECT_TRUE(std::ranges::is_sorted(highlights.sample));
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
    // The left half of the lens is red and the right half green; blue passes everywhere.
    return std::make_shared<AperturePicture>(AperturePicture{2, 1, {1, 0, 1, 0, 1, 1}});
}

TEST(LensGatherOfAPoint, IsThePictureOfTheAperture) {
    for (const ApertureShape &shape :
         {ApertureShape{.blades = 5, .rotation = 20}, ApertureShape{.blades = 3, .curvature = 0.5},
          ApertureShape{.squeeze = 2}, ApertureShape{.squeeze = 0.5}, ApertureShape{.spherical = 0.9},
          ApertureShape{.blades = 6, .spherical = -0.5}, ApertureShape{.spherical = {0.8, 0, -0.8}},
          ApertureShape{.picture = coloured_halves()}})
        for (const double c : {9.3, -13.7}) {
            const int size = 2 * int(std::abs(c) / std::min(1.0, shape.squeeze)) + 12;
            const PixelLamp lamp{{size / 2, size / 2 + 1}, 0.3f, -0.2f, c};
            const Image image = gather(lamp_alone(size, wide, lamp), wide, {.aperture = shape});
            // A disc has no spread of its own: round blades of equal weight.
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

// A lamp at x = 40, y = 40.5 and an opaque half plane x >= edge before it.
Ldi lamp_behind_edge(int size, const ThinLens &lens, double coc, double coc_before, int edge) {
    return make_ldi(windows_of_size(size, size), rgba_channels(), [&](int x, int y) {
        std::vector<Sample> samples;
        if (x >= edge) samples.push_back({depth_of(lens, coc_before), {0, 0, 0, 1}});
        if (x == 39 && y == 40) samples.push_back({depth_of(lens, coc), {1000, 500, 250, 1}, 0.5f, 0});
        return samples;
    });
}

// The area of the unit disc at x < t.
double disc_left_of(double t) {
    t = std::clamp(t, -1.0, 1.0);
    return t * std::sqrt(1 - t * t) + std::asin(t) + std::numbers::pi / 2;
}

// Through lens point u the edge is at edge + c' u.x, and the lamp at 40 + c u.x. The lamp is hidden where u.x (c' - c)
// >= 40 - edge, so each pixel shines by the share of its light from the rest of the lens.
TEST(LensGatherOfAPoint, ShinesByTheShareOfTheLensThatSeesIt) {
    struct Case {
        double coc, coc_before;
        int edge;
    };
    for (const Case &c : {Case{20, 0, 40}, Case{20, -7, 45}, Case{20, 5, 36}, Case{-10, -20, 42}}) {
        const int size = 80;
        const Image image = gather(lamp_behind_edge(size, wide, c.coc, c.coc_before, c.edge), wide);
        const double magnification = c.coc / (c.coc - c.coc_before);
        const double shadow = 40 + magnification * (c.edge - 40); // hidden: on the farther side
        double worst = 0, sum = 0, expected_sum = 0;
        const double radius = std::abs(c.coc);
        for (int x = 0; x < size; ++x) {
            double column = 0;
            for (int y = 0; y < size; ++y) column += double(image.at(red_channel, x, y));
            const double lit_from = magnification > 0 ? x : std::max<double>(x, shadow),
                         lit_to = magnification > 0 ? std::min<double>(x + 1, shadow) : x + 1;
            const double area = lit_to <= lit_from ? 0
                                                   : disc_left_of((lit_to - 40) / radius) -
                                                         disc_left_of((lit_from - 40) / radius);
            const double expected = 1000 * area / std::numbers::pi;
            worst = std::max(worst, std::abs(column - expected));
            sum += column;
            expected_sum += expected;
        }
        const double brightest_column = 1000 * 2 / (std::numbers::pi * radius);
        EXPECT_LT(worst, brightest_column / 32) << c.coc << " " << c.coc_before;
        EXPECT_NEAR(sum, expected_sum, brightest_column / 32) << c.coc << " " << c.coc_before;
    }
}

// The area of the unit disc at a < x < b.
double disc_between(double a, double b) { return b <= a ? 0 : disc_left_of(b) - disc_left_of(a); }

// A thin post x in [39, 43) before a lamp in the middle of pixel (36, 36): the share of the lens that sees the lamp, by
// the area of the disc on either side of the post. The lamp sees the left edge at the u.x with (39 - 36.5) = u.x (c -
// c'), the right edge likewise.
struct Post {
    double left = 39, right = 43;
    double share_seen(const ThinLens &lens, double lamp_z, double post_z) const {
        const double apart = circle_of_confusion(lens, lamp_z) - circle_of_confusion(lens, post_z);
        return 1 - disc_between((left - 36.5) / apart, (right - 36.5) / apart) / std::numbers::pi;
    }
    Ldi ldi(double lamp_z, double post_z) const {
        return make_ldi(windows_of_size(80, 72), rgba_channels(), [&](int x, int y) {
            std::vector<Sample> samples;
            if (x >= left && x < right) samples.push_back({float(post_z), {0, 0, 0, 1}});
            if (x == 36 && y == 36) samples.push_back({float(lamp_z), {1000, 500, 250, 1}});
            return samples;
        });
    }
};

double light_in(const Image &image) {
    double sum = 0;
    for (const float v : image.plane(red_channel)) sum += double(v);
    return sum;
}

// In steps of focus (from 2.4 pixels of CoC behind it to 0.9 in front) and of the aperture, the light is the share of
// the lens that sees the lamp, to 0.2 %: the cells of the lens have 64 points each in separate rows and columns, so an
// edge that crosses the 32 columns of cells hides 1/2048 of the lens at a time.
TEST(LensGatherOfAPoint, BehindAPostShinesByItsShareInSmallStepsOfFocusAndAperture) {
    const Post post;
    const double lamp_z = 8, post_z = 2;
    const Ldi ldi = post.ldi(lamp_z, post_z);
    double least = 1, most = 0;
    for (int step = 0; step <= 100; ++step) {
        ThinLens lens{.radius = 0.034, .focal_px = 640, .focus = 4.2 + 0.08 * step};
        if (step % 2 == 1) lens.radius *= 0.5 + 0.007 * step, lens.focus = 6.5;
        const double expected = post.share_seen(lens, lamp_z, post_z);
        least = std::min(least, expected);
        most = std::max(most, expected);
        ASSERT_NEAR(light_in(gather(ldi, lens)), 1000 * expected, 2)
            << "focus " << lens.focus << ", radius " << lens.radius;
    }
    EXPECT_LT(least, 0.75);
    EXPECT_GT(most, 0.85);
}

// A lamp that goes through focus shrinks and grows smoothly: no pixel's second difference exceeds an eighth of the
// lamp's light there, except in focus, because light beside the pixel grows with |CoC|.
TEST(LensGatherOfAPoint, GoesThroughFocusSmoothly) {
    const Post post;
    const Ldi ldi = post.ldi(8, 2);
    std::vector<Image> pictures;
    for (int frame = 0; frame < 48; ++frame)
        pictures.push_back(gather(ldi, {.radius = 0.034, .focal_px = 640, .focus = 5 + 0.1 * frame}));
    for (std::size_t frame = 1; frame + 1 < pictures.size(); frame += frame == 29 ? 2 : 1)
        for (int y = 30; y < 43; ++y)
            for (int x = 30; x < 43; ++x) {
                const auto at = [&](std::size_t f) { return double(pictures[f].at(red_channel, x, y)); };
                const double around = at(frame - 1) + at(frame) + at(frame + 1);
                ASSERT_LE(std::abs(at(frame - 1) - 2 * at(frame) + at(frame + 1)), 0.125 * around + 1.5)
                    << frame << " " << x << " " << y;
            }
}

// Nothing else moves: from frame to frame each pixel follows the closed form above, without jumps.
TEST(LensGatherOfAPoint, StaysSteadyInAPullOfFocus) {
    const int size = 80, frames = 12;
    std::vector<Image> pictures;
    for (int frame = 0; frame < frames; ++frame) {
        ThinLens lens = wide;
        const Ldi ldi = lamp_behind_edge(size, wide, 20, 2, 41);
        lens.focus *= 1 + 0.0005 * frame;
        pictures.push_back(gather(ldi, lens));
    }
    const double brightness = 1000 / (std::numbers::pi * 20 * 20);
    double worst = 0;
    for (int frame = 1; frame + 1 < frames; ++frame)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const auto at = [&](int f) { return double(pictures[std::size_t(f)].at(red_channel, x, y)); };
                worst = std::max(worst, std::abs(at(frame - 1) - 2 * at(frame) + at(frame + 1)));
            }
    EXPECT_LT(worst, brightness / 8); // a binary decision would make it `brightness`
}

// A round lamp some pixels wide before a dim wall. Nothing hides it, so its disc is even except for the rim, and holds
// all its light.
TEST(LensGatherOfALamp, IsAnEvenDisc) {
    for (const double diameter : {1.0, 3.0, 10.0})
        for (const double c : {30.0, 60.0, 140.0}) {
            const int size = 2 * int(c + diameter) + 8;
            // Centred in a pixel, or where four meet: lamps of 1, 9 and 80 pixels.
            const double middle = size / 2 + (int(diameter) % 2 == 1 ? 0.5 : 0);
            double emitted = 0;
            const Ldi ldi = make_ldi(windows_of_size(size, size), rgba_channels(), [&](int x, int y) {
                const bool lamp = std::hypot(x + 0.5 - middle, y + 0.5 - middle) <= diameter / 2;
                const float light = lamp ? 200.0f : 0.001f;
                if (lamp) emitted += double(light);
                return std::vector<Sample>{{depth_of(wide, c), {light, light, light, 1}}};
            });
            const Image image = gather(ldi, wide);
            double sum = 0, squares = 0, count = 0, all = 0;
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) {
                    const double v = double(image.at(red_channel, x, y));
                    all += v;
                    if (std::hypot(x + 0.5 - middle, y + 0.5 - middle) > c - diameter / 2 - 2) continue;
                    sum += v;
                    squares += v * v;
                    ++count;
                }
            const double mean = sum / count,
                         deviation = std::sqrt(std::max(0.0, squares / count - mean * mean));
            EXPECT_LT(deviation, 0.02 * mean) << "diameter " << diameter << ", CoC " << c;
            const double wall = 0.001 * size * size;
            EXPECT_NEAR(all, emitted + wall, 0.01 * emitted) << "diameter " << diameter << ", CoC " << c;
        }
}

// The parts of a mirror that are nearer than the pixel of a lamp do not hide it.
TEST(LensGatherOfALamp, IsWholeInATiltedMirror) {
    const auto mirror = [](double tilt) {
        return gather(make_ldi(windows_of_size(64, 64), rgba_channels(),
                               [&](int x, int y) {
                                   const float v = x == 31 && y == 32 ? 1000.0f : 0.1f;
                                   Sample sample{depth_of(wide, -6 - tilt * (y - 32)), {v, v, v, 1}};
                                   sample.image_z = depth_of(wide, 12);
                                   return std::vector<Sample>{sample};
                               }),
                      wide);
    };
    const Image straight = mirror(0), tilted = mirror(0.05);
    for (int y = 18; y < 48; ++y)
        for (int x = 16; x < 48; ++x)
            ASSERT_NEAR(tilted.at(red_channel, x, y), straight.at(red_channel, x, y), 0.02) << x << " " << y;
    EXPECT_GT(tilted.at(red_channel, 31, 38), 1);
}

// Mist of many thin samples before a lamp, and a fence of thick ones.
TEST(LensGatherOfAPoint, ShinesThroughWhatIsThin) {
    struct Mist {
        int count;
        float coverage;
    };
    for (const Mist &mist : {Mist{40, 0.02f}, Mist{1, 0.5f}, Mist{3, 0.3f}}) {
        const int size = 64;
        const Ldi ldi = make_ldi(windows_of_size(size, size), rgba_channels(), [&](int x, int y) {
            std::vector<Sample> samples;
            for (int k = 0; k < mist.count; ++k)
                samples.push_back({depth_of(wide, 2 + 0.05 * k), {0, 0, 0, mist.coverage}});
            if (x == 32 && y == 32) samples.push_back({depth_of(wide, 12), {1000, 500, 250, 1}});
            return samples;
        });
        const Image image = gather(ldi, wide);
        double sum = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) sum += double(image.at(red_channel, x, y));
        EXPECT_NEAR(sum, 1000 * std::pow(1 - double(mist.coverage), mist.count), 20) << mist.count;
    }
}

} // namespace
} // namespace sparselens
