#include "dof/lens/blocked_fixture.h"
#include "dof/lens/lens_gather.h"
#include "dof/lens/sharpen.h"
#include "lens/focus_field.h"
#include "lens/lens_looks.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

// A plane of CoC c that faces the camera; R, G and B are v, v / 2 and v / 4.
Ldi plane(double c, const std::function<double(int x, int y)> &value,
          std::vector<Channel> channels = rgba_channels()) {
    return make_ldi(windows_of_size(64, 64), channels, [&](int x, int y) {
        const float v = float(value(x, y));
        return std::vector<Sample>{{depth_of(lens, c), {v, v / 2, v / 4, 1}}};
    });
}

// Largest change of a sample in a channel.
double change(const Ldi &ldi, std::size_t channel = 0) {
    BlockedLdi blocked(ldi, lens);
    const SampleColours before = blocked.colours;
    sharpen_near_focus(ldi, lens, blocked.samples, blocked.colours);
    double largest = 0;
    for (std::size_t i = 0; i < before.count; ++i)
        largest = std::max(largest,
                           std::abs(double(blocked.colours.at(channel, i)) - double(before.at(channel, i))));
    return largest;
}

// Detail between calm areas, because detail everywhere counts as noise.
double checks(int x, int y) { return x / 8 % 2 == 0 ? 0.5 : (x + y) % 2 ? 0.8 : 0.2; }

TEST(Sharpen, LeavesAloneWhatIsFarFromFocusOrHasNoColour) {
    EXPECT_GT(change(plane(1, checks)), 0.1);
    for (const double c : {4.001, -4.001, 6.5, -50.0}) EXPECT_EQ(change(plane(c, checks)), 0) << c;
    EXPECT_EQ(change(plane(1, checks, {{"X"}, {"Y"}, {"Z1"}, {"A"}})), 0);
}

// A sample in focus, in the middle of its pixel, is seen without interpolation.
TEST(Sharpen, LeavesAloneWhatIsInFocus) { EXPECT_LT(change(plane(0, checks)), 1e-3); }

TEST(Sharpen, FadesOutTowardsLargeBlur) {
    double last = change(plane(2, checks));
    for (const double c : {3.0, 3.5, 3.9, 3.99}) {
        const double now = change(plane(c, checks));
        EXPECT_LT(now, last) << c;
        last = now;
    }
    EXPECT_LT(last, 0.01);
}

// A wave of w radians per pixel along both axes keeps 2 J1(w' c) / (w' c) of its amplitude under a disc of radius c, w'
// = sqrt(2) w. The gather's own interpolation removes more, which sharpening restores.
TEST(Sharpen, RestoresWhatInterpolationBlurs) {
    const double w = 2 * std::numbers::pi / 6;
    for (const double c : {0.6, 0.8, 1.3, -1.3}) {
        const auto amplitude_in = [&](const std::vector<Channel> &channels) {
            const Ldi ldi = plane(
                c, [&](int x, int y) { return 0.5 + 0.4 * std::sin(w * x + w * y); }, channels);
            Progress silent;
            const Image image = lens_gather(ldi, lens, ldi.windows.data, {.lens_samples = 1024}, silent);
            double sum = 0;
            for (int y = 8; y < 56; ++y)
                for (int x = 8; x < 56; ++x) sum += double(image.at(0, x, y)) * std::sin(w * x + w * y);
            return 2 * sum / (48 * 48);
        };
        const double r = std::sqrt(2) * w * std::abs(c), expected = 0.4 * 2 * std::cyl_bessel_j(1, r) / r;
        const double plain = amplitude_in({{"X"}, {"Y"}, {"Z1"}, {"A"}}),
                     sharpened = amplitude_in(rgba_channels());
        EXPECT_LT(plain, expected) << c;
        EXPECT_LT(std::abs(sharpened - expected), 0.35 * (expected - plain)) << c;
    }
}

TEST(Sharpen, LeavesNoiseAlone) {
    const auto noise = [](int x, int y) { return 0.5 + 0.1 * (random_unit(x, y, 1) - 0.5); };
    const Ldi ldi = plane(1, noise);
    BlockedLdi blocked(ldi, lens);
    const SampleColours before = blocked.colours;
    sharpen_near_focus(ldi, lens, blocked.samples, blocked.colours);
    double squares = 0;
    for (std::size_t i = 0; i < before.count; ++i)
        squares += std::pow(double(blocked.colours.at(0, i)) - double(before.at(0, i)), 2);
    EXPECT_LT(std::sqrt(squares / double(before.count)),
              0.05 * 0.1 / std::sqrt(12)); // of the noise's standard deviation
    // An edge between noisy areas is not noise.
    const auto edge = [&](int x, int y) { return noise(x, y) + (x < 32 ? 0 : 2); };
    EXPECT_GT(change(plane(1, edge)), 0.1);
}

// The made-up samples beside the noise are calm; if they counted, the noise would be taken for detail.
TEST(Sharpen, AsksOnlyWhatWasSeenForItsNoise) {
    const Ldi ldi = plane(1, [](int x, int y) { return x < 20 ? 0.5 + 0.1 * random_unit(x, y, 1) : 0.5; });
    const auto change = [&](const std::optional<Imath::Box2i> &seen) {
        const LensLooks none;
        const Aperture aperture(none.aperture);
        const PictureFrame frame = picture_frame(ldi.windows, none);
        const FocusField field(none, lens, frame);
        const SharpenLooks looks{aperture, field, 0, seen};
        BlockedLdi blocked(ldi, lens);
        const SampleColours before = blocked.colours;
        sharpen_near_focus(ldi, lens, blocked.samples, blocked.colours, &looks);
        double squares = 0;
        for (std::size_t i = 0; i < before.count; ++i)
            squares += std::pow(double(blocked.colours.at(0, i)) - double(before.at(0, i)), 2);
        return squares;
    };
    EXPECT_LT(change(Imath::Box2i({0, 0}, {19, 63})), 0.1 * change({}));
}

// As the aperture opens, the wall behind the edge of a lamp gradually becomes another surface, not from one frame to
// the next.
TEST(Sharpen, LetsGoOfASurfaceByAndBy) {
    const auto edge_at = [](double rf) { // R F, which sets the distance between the surfaces
        const ThinLens by{.radius = rf / 640, .focal_px = 640, .focus = 6};
        const Ldi ldi = make_ldi(windows_of_size(64, 64), rgba_channels(), [](int x, int) {
            const float v = x < 30 ? 0.1f : x < 33 ? 50.0f : x == 33 ? 5.0f : 0.1f;
            return std::vector<Sample>{{x < 30 || x > 33 ? 22.0f : 11.0f, {v, v / 2, v / 4, 1}}};
        });
        BlockedLdi blocked(ldi, by);
        sharpen_near_focus(ldi, by, blocked.samples, blocked.colours);
        const std::uint64_t sample = ldi.pixel(ldi.windows.index(Imath::V2i(33, 32))).front();
        const std::size_t place =
            place_of(blocked.samples, ldi, ldi.windows.index(Imath::V2i(33, 32)), std::uint32_t(sample));
        return double(blocked.colours.at(0, place));
    };
    constexpr double joined = 0.3 * 22, parted = 0.55 * 22; // pixels of disparity between the surfaces
    EXPECT_EQ(edge_at(parted), 5);
    EXPECT_LT(edge_at(joined), 2);
    double last = edge_at(joined);
    for (int step = 1; step <= 100; ++step) {
        const double now = edge_at(joined + (parted - joined) * step / 100);
        EXPECT_LT(std::abs(now - last), 0.3) << step;
        last = now;
    }
}

TEST(Sharpen, NeverMakesLightNegative) {
    const auto lamps = [](int x, int y) {
        return random_unit(x, y, 1) > 0.9 ? 100 * random_unit(x, y, 2) : 0.01 * random_unit(x, y, 3);
    };
    const Ldi ldi = plane(0.8, lamps);
    BlockedLdi blocked(ldi, lens);
    sharpen_near_focus(ldi, lens, blocked.samples, blocked.colours);
    for (std::size_t i = 0; i < blocked.colours.count; ++i)
        for (std::size_t k = 0; k < 3; ++k) ASSERT_GE(blocked.colours.at(k, i), -1e-6f);
    EXPECT_GT(change(ldi), 1);
}

// The neighbour of the wall beside a lamp is the wall behind the lamp, not the lamp, so it gives nothing to the lamp.
TEST(Sharpen, MakesNoLightBeforeAWall) {
    const Ldi ldi = make_ldi(windows_of_size(64, 64), rgba_channels(), [](int x, int y) {
        std::vector<Sample> samples{{depth_of(lens, 1.2), {0.2f, 0.2f, 0.2f, 1}}};
        if (x == 32 && y == 32) samples.insert(samples.begin(), {depth_of(lens, 1), {500, 500, 500, 1}});
        return samples;
    });
    BlockedLdi blocked(ldi, lens);
    sharpen_near_focus(ldi, lens, blocked.samples, blocked.colours);
    double light = 0;
    for (std::size_t i = 0; i < blocked.colours.count; ++i) light += double(blocked.colours.at(0, i));
    EXPECT_NEAR(light, 500 + 64 * 64 * 0.2, 0.01);
}

// Denoisers leave negative colours. A sample without a brighter neighbour gives nothing away.
TEST(Sharpen, KeepsNegativeColours) {
    const Ldi ldi = plane(1, [](int, int) { return -1e-3; });
    BlockedLdi blocked(ldi, lens);
    sharpen_near_focus(ldi, lens, blocked.samples, blocked.colours);
    for (std::size_t i = 0; i < blocked.colours.count; ++i)
        ASSERT_NEAR(double(blocked.colours.at(0, i)), -1e-3, 1e-9) << i;
}

TEST(Sharpen, ChangesAllLayersByTheSameWeightsAndNeitherCoverageNorIds) {
    std::vector<Channel> channels = rgba_channels();
    channels.push_back({"copy.R"});
    channels.push_back({"rest.R"});
    channels.push_back({"id", PixelType::uint32});
    const Ldi ldi = make_ldi(windows_of_size(64, 64), channels, [](int x, int y) {
        const float v = float(checks(x, y)), id = std::bit_cast<float>(std::uint32_t(x));
        return std::vector<Sample>{{depth_of(lens, 1), {v, v / 2, v / 4, 0.9f, v, 1 - v, id}}};
    });
    BlockedLdi blocked(ldi, lens);
    const SampleColours before = blocked.colours;
    sharpen_near_focus(ldi, lens, blocked.samples, blocked.colours);
    for (std::size_t i = 0; i < before.count; ++i) {
        if (blocked.samples.source[i] == BlockedSamples::background) continue;
        ASSERT_EQ(blocked.colours.at(4, i), blocked.colours.at(0, i));
        ASSERT_NEAR(blocked.colours.at(5, i) + blocked.colours.at(0, i), 1, 1e-6);
        ASSERT_EQ(blocked.colours.at(3, i), 0.9f);
        ASSERT_EQ(std::bit_cast<std::uint32_t>(blocked.colours.at(6, i)),
                  std::bit_cast<std::uint32_t>(before.at(6, i)));
    }
}

// Sheets and mist that are the same all over the picture have no detail, however close they are.
TEST(Sharpen, TellsTheSamplesOfAStackApart) {
    for (const double distance : {0.3, 1e-6}) {
        const Ldi ldi = make_ldi(windows_of_size(64, 64), rgba_channels(), [&](int x, int) {
            std::vector<Sample> samples{{depth_of(lens, 1), {0.2f, 0.2f, 0.1f, 0.4f}},
                                        {depth_of(lens, 1 + distance), {0.6f, 0.1f, 0.3f, 0.7f}},
                                        {depth_of(lens, 1 + 2 * distance), {0.1f, 0.9f, 0.9f, 1}}};
            if (x == 20) samples.erase(samples.begin());
            return samples;
        });
        BlockedLdi blocked(ldi, lens);
        const SampleColours before = blocked.colours;
        sharpen_near_focus(ldi, lens, blocked.samples, blocked.colours);
        for (std::size_t i = 0; i < before.count; ++i) {
            if (std::abs(blocked.samples.x[i] - 20.5f) < 2) continue;
            ASSERT_EQ(blocked.colours.at(0, i), before.at(0, i)) << distance;
        }
    }
}

} // namespace
} // namespace sparselens
