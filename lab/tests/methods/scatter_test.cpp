#include "dof/selective/selective.h"
#include "lab/methods/scatter.h"
#include "support/lens_ldi.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

Image scattered(const Ldi &ldi, const ThinLens &by, std::size_t fragments = std::size_t(1) << 24) {
    Progress progress;
    return scatter(ldi, by, {.fragments = fragments}, progress);
}

Image gathered(const Ldi &ldi, const ThinLens &by) {
    Progress progress;
    return selective_gather(ldi, by, {.layers = 32}, progress);
}

TEST(Scatter, OneSampleMakesOneDisc) {
    const Ldi ldi = make_ldi(windows_of_size(21, 21), {{"Y", PixelType::half}}, [](int x, int y) {
        std::vector<Sample> samples{{5, {0}}};
        if (x == 10 && y == 10) samples.insert(samples.begin(), Sample{depth_of(lens, -4), {1}});
        return samples;
    });
    const Image image = scattered(ldi, lens);
    double sum = 0;
    for (const float value : image.values) sum += double(value);
    EXPECT_NEAR(sum, 1, 1e-6);
    EXPECT_NEAR(image.at(0, 10, 10), 1 / (3.14159265358979 * 16), 1e-6);
    EXPECT_EQ(image.at(0, 10, 15), 0);
}

// The selective gather with enough layers and the scatter are two routes to the same picture.
TEST(Scatter, AgreesWithTheSelectiveGather) {
    for (std::uint32_t i = 0; i < 4; ++i) {
        Windows windows = windows_of_size(67, 70);
        windows.data = {{-5, 3}, {61, 72}};
        windows.pixel_aspect = i == 2 ? 1.5f : 1.0f;
        ThinLens by = lens;
        by.pixel_aspect = double(windows.pixel_aspect);
        if (i == 3) by.focus = 1e9;
        const Ldi ldi = random_surfaces(windows, lens, i % 2 == 0, 20 + i);
        EXPECT_LT(largest_difference(scattered(ldi, by), gathered(ldi, by)), 1e-4) << "LDI " << i;
    }
}

TEST(Scatter, AgreesWhereOnePixelIsHugelyBlurred) {
    for (const double c : {-60.0, -1000.0, -9000.0}) {
        const ThinLens wide{.radius = 6, .focal_px = 640, .focus = 5};
        const Ldi ldi = make_ldi(windows_of_size(80, 70), rgba_channels(), [&](int x, int y) {
            std::vector<Sample> samples{
                {5 + 0.01 * random_unit(x, y, 1), {float(random_unit(x, y, 2)), 0.5f, 0.2f, 1}}};
            if (x == 41 && y == 17)
                samples.insert(samples.begin(), Sample{depth_of(wide, c), {1000, 10, 1, 1}});
            return samples;
        });
        EXPECT_LT(largest_difference(scattered(ldi, wide), gathered(ldi, wide)), 1e-4) << "c " << c;
    }
}

TEST(Scatter, PartsOfAnySizeGiveTheSamePicture) {
    const Ldi ldi = random_surfaces(windows_of_size(40, 37), lens, false, 2);
    const Image whole = scattered(ldi, lens);
    for (const std::size_t fragments : {std::size_t(1), std::size_t(100000), std::size_t(3000000)})
        EXPECT_EQ(scattered(ldi, lens, fragments).values, whole.values);
}

} // namespace
} // namespace sparselens
