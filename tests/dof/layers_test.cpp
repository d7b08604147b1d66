// Further layers are defocused with the visibility of the beauty: light layers that add up to it still do, with
// highlights and near focus too. Ids are never mixed.
#include "deep/tidy.h"
#include "dof/methods.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>
#include <half.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace sparselens {
namespace {

constexpr int layers = 3;
const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

// Beauty R, G, B, A and layers with the same channels, which add up to it in half without rounding: multiples of 1/256.
Ldi lit_by_layers(const Windows &windows) {
    std::vector<Channel> channels = rgba_channels();
    for (int l = 0; l < layers; ++l)
        for (const char *name : {"R", "G", "B"})
            channels.push_back({"light" + std::to_string(l) + "." + name});
    channels.push_back({"id", PixelType::uint32});
    return make_ldi(windows, channels, [&](int x, int y) {
        std::vector<Sample> samples;
        for (int i = 0; i < 1 + int(2 * random_unit(x, y, 3)); ++i) {
            const auto random = [&](std::uint32_t k) { return random_unit(x, y, 31 * k + std::uint32_t(i)); };
            const float alpha = random(1) < 0.7 ? 1 : 0.5f, lamp = random(2) > 0.99 ? 40 : 1;
            std::vector<float> values{0, 0, 0, alpha};
            for (int l = 0; l < layers; ++l)
                for (std::size_t k = 0; k < 3; ++k) {
                    const double light = random(10 + 3 * std::uint32_t(l) + std::uint32_t(k));
                    values.push_back(std::floor(float(light) * 32 * alpha) / 256 * lamp);
                    values[k] += values.back();
                }
            values.push_back(std::bit_cast<float>(0x7fc00000u + std::uint32_t(x + 100 * y + 10000 * i)));
            samples.push_back({depth_of(lens, -5 + 3 * i + 0.5 * random(40)), values, float(random(5) - 0.5),
                               float(random(6) - 0.5)});
        }
        return samples;
    });
}

Image gathered(const GatherMethod &method, const Ldi &ldi, const ThinLens &by) {
    Progress silent;
    return method.gather(ldi, by, ldi.windows.data, {}, silent);
}

double as_half(float v) { return double(float(Imath::half(v))); }

TEST(Layers, AddUpToTheBeauty) {
    const Ldi ldi = lit_by_layers(windows_of_size(150, 70));
    for (const GatherMethod &method : gather_methods()) {
        const Image out = gathered(method, ldi, lens);
        double worst = 0; // relative to the largest allowed error
        for (std::size_t i = 0; i < out.windows.pixels(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                double sum = 0;
                for (std::size_t l = 0; l < layers; ++l) sum += as_half(out.plane(4 + 3 * l + k)[i]);
                const double beauty = as_half(out.plane(k)[i]);
                // Each value was rounded to a half, by at most half a unit in the last place of the beauty.
                const double half_ulp = std::max(std::abs(beauty), 0x1p-14) * 0x1p-11;
                worst = std::max(worst, std::abs(sum - beauty) / ((layers + 1) * half_ulp));
            }
        EXPECT_LE(worst, 1) << method.name;
        EXPECT_GT(worst, 0) << method.name; // something was rounded
    }
}

TEST(Layers, IdsAreTheFrontSamples) {
    const Ldi ldi = lit_by_layers(windows_of_size(40, 20));
    const std::size_t id = find_channel(ldi.channels, "id");
    Ldi sharp = ldi;
    for (float &z : sharp.z) z = float(lens.focus); // CoC 0; one sample per pixel, because they may be untidy
    const Ldi tidied = tidy(sharp);
    for (const GatherMethod &method : gather_methods())
        for (const Ldi &in : {ldi, tidied}) {
            const Image out = gathered(method, in, lens);
            for (std::size_t i = 0; i < out.windows.pixels(); ++i)
                ASSERT_EQ(std::bit_cast<std::uint32_t>(out.plane(id)[i]),
                          std::bit_cast<std::uint32_t>(in.values[id][in.begin[i]]))
                    << method.name;
        }
}

} // namespace
} // namespace sparselens
