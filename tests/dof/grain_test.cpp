// Grain: noise of known strength comes back where a photograph is blurred, and nowhere else.
#include "base/error.h"
#include "base/numbers.h"
#include "chain/take_picture.h"
#include "dof/grain.h"
#include "lens/photograph.h"
#include "support/lens_ldi.h"

#include <ImfIntAttribute.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

namespace sparselens {
namespace {

// A normal number for a pixel of a channel, by Box and Muller: not the noise of the code.
double normal(int x, int y, int channel, int frame) {
    const std::uint32_t seed =
        mix_bits(std::uint32_t(x + 1000 * y), mix_bits(std::uint32_t(channel), std::uint32_t(frame + 99)));
    const double u = 1 - unit_interval(mix_bits(seed, 1)), v = unit_interval(mix_bits(seed, 2));
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

// Steps of grey, top down, sharp at the left and blurred at the right: a photograph, focused on disparity 1.
constexpr int width = 384, height = 768, steps = 4, half_width = width / 2;
double grey(int y) { return 0.05 + 0.25 * (y * steps / height); }

struct Noise {
    double constant = 0, of_light = 0; // of the variance; the second for each unit of light
    double shared = 0;                 // by the three channels
    int frame = 0;
    double texture = 0; // amplitude of a weave in two thirds of the picture
    double deviation(double light) const { return std::sqrt(constant + of_light * light); }
};

OpenedLdi photograph(const Noise &noise) {
    OpenedLdi in;
    in.name = "x.png";
    in.ldi = make_ldi(windows_of_size(width, height), rgba_channels(), [&](int x, int y) {
        const double light = grey(y) + 1e-6 * x, s = noise.deviation(light);
        const double weave = y % (height / steps) >= 64 ? noise.texture * ((x / 2 + y / 2) % 2 - 0.5) : 0;
        std::vector<float> values;
        for (int k = 0; k < 3; ++k)
            values.push_back(float(light + weave +
                                   s * std::sqrt(1 - noise.shared) * normal(x, y, k, noise.frame) +
                                   s * std::sqrt(noise.shared) * normal(x, y, 3, noise.frame)));
        values.push_back(1);
        return std::vector<Sample>{{depth_of_disparity(x < half_width ? 1 : 0), values}};
    });
    in.header = Imf::Header(in.ldi.windows.display, in.ldi.windows.data);
    in.samples_read = in.ldi.samples();
    in.camera.focal_length_mm = in.camera.sensor_width_mm = 36;
    in.camera.focus_distance = depth_of_disparity(1);
    in.depth = DepthMeaning::disparity;
    return in;
}

Image taken(const OpenedLdi &in, double blur, std::optional<double> grain = {}, int frame = 0) {
    PictureRequest request;
    request.blur = PhotographBlur{blur, false};
    request.grain = grain;
    Progress silent;
    return take_picture(in, request, {.progress = silent, .notify = [](const Notice &) {}, .frame = frame})
        .image;
}

// The deviation of a channel from its mean, in one step of grey, of the sharp or the blurred half.
double deviation(const Image &image, std::size_t channel, int step, bool blurred) {
    double sum = 0, squares = 0, count = 0;
    constexpr int margin = 24, rows = height / steps;
    for (int y = step * rows + margin; y < (step + 1) * rows - margin; ++y)
        for (int x = margin; x < half_width - margin; ++x) {
            const double v = double(image.at(channel, x + (blurred ? half_width : 0), y));
            sum += v, squares += v * v, ++count;
        }
    return std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
}

// Three ISO numbers, whose noise grows with the light, and blurs from half a pixel on.
TEST(Grain, IsThatOfSharpParts) {
    for (const double iso : {1.0, 4.0, 16.0})
        for (const double blur : {0.6, 1.0, 2.0, 5.0, 12.0}) {
            const OpenedLdi in = photograph({.constant = iso * 1e-6, .of_light = iso * 1e-5});
            const Image picture = taken(in, blur);
            ASSERT_EQ(picture.channels, in.ldi.channels);
            for (int step = 0; step < steps; ++step)
                for (std::size_t k = 0; k < 3; ++k) {
                    const double sharp = deviation(picture, k, step, false);
                    EXPECT_NEAR(deviation(picture, k, step, true) / sharp, 1, 0.1)
                        << iso << ' ' << blur << ' ' << step << ' ' << k;
                }
        }
}

TEST(Grain, HasTheStrengthThatIsAskedFor) {
    const OpenedLdi in = photograph({.constant = 1e-4});
    EXPECT_LT(deviation(taken(in, 6, 0), 1, 2, true), 0.15e-2);
    EXPECT_NEAR(deviation(taken(in, 6, 0.5), 1, 2, true), 0.5e-2, 0.05e-2);
}

TEST(Grain, LeavesWhatIsInFocusAndOtherChannels) {
    const OpenedLdi in = photograph({.constant = 1e-4});
    const Image with = taken(in, 6), without = taken(in, 6, 0);
    for (int y = 100; y < 200; ++y)
        for (int x = 0; x < width; ++x)
            for (std::size_t k = 0; k < 4; ++k)
                if (k == 3 || x < 100) {
                    ASSERT_EQ(with.at(k, x, y), without.at(k, x, y)) << x << ' ' << y;
                }
}

// Renders, and what has no noise that shows: flat parts between texture, and light that is rounded to 8 bits.
TEST(Grain, IsNothingWithoutNoise) {
    const OpenedLdi faint = photograph({.constant = 2e-7}), seen = photograph({.constant = 1e-5});
    EXPECT_EQ(taken(faint, 6).values, taken(faint, 6, 0).values);
    EXPECT_NE(taken(seen, 6).values, taken(seen, 6, 0).values);
    OpenedLdi in = photograph({.texture = 0.1});
    in.header.insert("photograph:bits", Imf::IntAttribute(8));
    EXPECT_EQ(taken(in, 6).values, taken(in, 6, 0).values);
    for (int y = 0; y < height; ++y) // a ramp
        for (int x = 0; x < width; ++x)
            for (std::size_t k = 0; k < 3; ++k) {
                const double shown = std::round(40 + 170.0 * (x + 0.3 * y) / (width + 0.3 * height)) / 255;
                in.ldi.values[k][std::size_t(y * width + x)] = float(std::pow((shown + 0.055) / 1.055, 2.4));
            }
    EXPECT_EQ(taken(in, 6).values, taken(in, 6, 0).values);
    OpenedLdi render = photograph({.constant = 1e-4});
    render.depth = DepthMeaning::planar;
    render.camera.lens_radius = 6.0 / width;
    PictureRequest request;
    Progress silent;
    const PictureWork work{silent, [](const Notice &) {}};
    EXPECT_LT(deviation(take_picture(render, request, work).image, 1, 2, true), 0.15e-2);
    request.grain = 1;
    EXPECT_THROW(take_picture(render, request, work), UsageError);
}

TEST(Grain, IsNotTexture) {
    const Grain grain = measure_grain(photograph({.constant = 1e-4, .texture = 0.1}).ldi, 0);
    EXPECT_NEAR(grain.deviation(1, 0.3f), 0.01, 0.002);
}

TEST(Grain, HasTheColoursOfTheNoise) {
    for (const double shared : {0.0, 0.5, 1.0})
        EXPECT_NEAR(measure_grain(photograph({.constant = 1e-4, .shared = shared}).ldi, 0).correlation,
                    shared, 0.1);
    const OpenedLdi in = photograph({.constant = 1e-4, .shared = 1});
    const Image picture = taken(in, 12);
    double different = 0;
    for (int x = half_width + 24; x < width - 24; ++x)
        different = std::max(different, std::abs(double(picture.at(0, x, 100) - picture.at(1, x, 100))));
    EXPECT_LT(different, 0.02); // 0.06 of independent noise
}

// Frames have the same strength, and each has noise of its own, whatever the number of threads.
TEST(Grain, IsSteady) {
    std::vector<Image> pictures;
    for (const int frame : {1, 2, 3}) {
        const OpenedLdi in = photograph({.constant = 1e-4, .frame = frame});
        pictures.push_back(taken(in, 8, {}, frame));
        for (int step = 0; step < steps; ++step)
            EXPECT_NEAR(deviation(pictures.back(), 1, step, true), deviation(pictures[0], 1, step, true),
                        0.03e-2);
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(taken(in, 8, {}, frame).values, pictures.back().values);
    }
    Image change = pictures[0];
    for (std::size_t i = 0; i < change.values.size(); ++i) change.values[i] -= pictures[1].values[i];
    EXPECT_NEAR(deviation(change, 1, 1, true), std::sqrt(2.0) * 1e-2, 0.15e-2);
}

} // namespace
} // namespace sparselens
