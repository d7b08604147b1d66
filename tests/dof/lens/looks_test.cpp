// Properties of the lens picture that hold for every look.
#include "dof/lens/lens_gather.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5}; // CoC up to 7.7 px behind focus

Image gather(const Ldi &ldi, const LensLooks &looks, const ThinLens &by = lens) {
    Progress silent;
    return lens_gather(ldi, by, ldi.windows.data, {.looks = looks}, silent);
}

// A picture with a bright corner and different colours.
std::shared_ptr<const AperturePicture> picture() {
    auto made = std::make_shared<AperturePicture>(AperturePicture{7, 5, {}});
    for (int i = 0; i < 35; ++i)
        made->rgb.insert(made->rgb.end(), {1 + float(i % 7), 3, i < 7 ? 9.0f : 1.0f});
    return made;
}

std::vector<LensLooks> all_looks() {
    return {{.aperture = {.blades = 6, .rotation = 15}},
            {.aperture = {.blades = 3, .curvature = 0.3}},
            {.aperture = {.squeeze = 2}},
            {.aperture = {.blades = 5, .squeeze = 0.5}},
            {.aperture = {.spherical = 0.9}},
            {.aperture = {.blades = 7, .spherical = -0.9}},
            {.aperture = {.picture = picture()}},
            {.aperture = {.squeeze = 1.5, .spherical = 0.5, .picture = picture()}}};
}

TEST(LensLooks, ConstantStaysConstantAndOpaque) {
    // Planes of one colour: behind focus, in front, and strips of one before the other, half of them half covered.
    const std::array<float, 4> colour{0.4f, 0.7f, 0.2f, 1};
    const auto strips = [&](int x, int y) {
        std::vector<Sample> samples{{depth_of(lens, 6), {0.4f, 0.7f, 0.2f, 1}}};
        const float cover = y < 24 ? 1.0f : 0.5f;
        if (x / 6 % 2 == 0)
            samples.insert(samples.begin(),
                           {depth_of(lens, -5), {0.4f * cover, 0.7f * cover, 0.2f * cover, cover}});
        return samples;
    };
    const Ldi ldi = make_ldi(windows_of_size(48, 48), rgba_channels(), strips);
    for (const LensLooks &looks : all_looks()) {
        const Image image = gather(ldi, looks);
        for (std::size_t k = 0; k < 4; ++k)
            for (const float v : image.plane(k)) ASSERT_NEAR(v, colour[k], 1e-4);
    }
}

TEST(LensLooks, ChangeThePicture) {
    const Ldi ldi = random_surfaces(windows_of_size(96, 64), lens, false, 1);
    const Image round = gather(ldi, {});
    for (const LensLooks &looks : all_looks()) EXPECT_GT(largest_difference(gather(ldi, looks), round), 0.01);
    EXPECT_EQ(largest_difference(gather(ldi, {.aperture = {.blades = 4, .curvature = 1}}), round), 0);
}

TEST(LensLooks, GiveTheSameBitsOnAnyNumberOfThreads) {
    const Ldi ldi = random_surfaces(windows_of_size(150, 100), lens, false, 2);
    for (const LensLooks &looks : all_looks()) {
        const Image many = gather(ldi, looks);
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(gather(ldi, looks).values, many.values);
    }
}

// Data has no colour and no rim: it is gathered as through an even lens of one colour.
TEST(LensLooks, LeaveDataAlone) {
    std::vector<Channel> channels = rgba_channels();
    channels.push_back({"velocity"});
    const auto sample = [](int x, int y) {
        const float v = float(random_unit(x, y, 3));
        return std::vector<Sample>{{depth_of(lens, x < 32 ? 5 : -4), {v, v, v, 1, v}}};
    };
    const Ldi ldi = make_ldi(windows_of_size(64, 64), channels, sample);
    const Image round = gather(ldi, {}), ringed = gather(ldi, {.aperture = {.spherical = 1}});
    for (std::size_t i = 0; i < round.plane(4).size(); ++i)
        ASSERT_NEAR(ringed.plane(4)[i], round.plane(4)[i], 1e-6);
    EXPECT_GT(std::abs(ringed.plane(0)[64 * 32 + 32] - round.plane(0)[64 * 32 + 32]), 1e-4);
}

} // namespace
} // namespace sparselens
