// The kernel of the selective gather compared with the CPU.
#include "dof/selective/selective.h"
#include "gpu/gpu_fixture.h"
#include "support/lens_ldi.h"

#include <algorithm>
#include <cmath>

namespace sparselens::gpu {
namespace {

const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

Image gather(const Ldi &ldi, const ThinLens &by, const SelectiveOptions &options) {
    Progress silent;
    return selective_gather(ldi, by, options, silent);
}

double largest_of(const Image &image) {
    double largest = 0;
    for (const float value : image.values) largest = std::max(largest, std::abs(double(value)));
    return largest;
}

class SelectiveDeviceTest : public TileDeviceTest {
protected:
    // Compares both pictures; the device must have computed all tiles.
    void expect_same(const Ldi &ldi, const ThinLens &by = lens, int layers = 8) {
        const Image expected = gather(ldi, by, {.layers = layers});
        if (!device) device = open_gather_device(*info, watch());
        const Image image = gather(ldi, by, {layers, device.get()});
        const TileReport did = device->take_report();
        EXPECT_GT(did.on_device, 0u);
        EXPECT_EQ(did.on_cpu, Tiles());
        EXPECT_EQ(did.failure, "");
        // Sums of 64 bits in the same order: only rounding.
        EXPECT_LE(largest_difference(image, expected), 1e-6 * largest_of(expected));
        EXPECT_EQ(gather(ldi, by, {layers, device.get()}).values, image.values);
        device->take_report();
    }
};

TEST_F(SelectiveDeviceTest, SurfacesAreTheCpusWithAnyNumberOfLayers) {
    for (const bool opaque : {true, false})
        for (const int layers : {1, 3, 100})
            expect_same(random_surfaces(windows_of_size(45, 30), lens, opaque, 1), lens, layers);
}

TEST_F(SelectiveDeviceTest, WindowsAndPixelsOfAnyShapeAreTheCpus) {
    Windows windows = windows_of_size(40, 45);
    windows.data = {{-5, 3}, {41, 42}};
    windows.pixel_aspect = 1.5f;
    ThinLens by = lens;
    by.pixel_aspect = 1.5;
    expect_same(random_surfaces(windows, lens, false, 2), by);
    by.focus = 1e9;
    expect_same(random_surfaces(windows, lens, true, 3), by);
}

TEST_F(SelectiveDeviceTest, DiscsOfAnySizeAreTheCpus) {
    const ThinLens wide{.radius = 6, .focal_px = 640, .focus = 5};
    for (const double c : {-1e-3, -0.4, -2.6, -60.0, -1000.0, -9000.0}) {
        const Ldi ldi = make_ldi(windows_of_size(60, 30), rgba_channels(), [&](int x, int y) {
            std::vector<Sample> samples{
                {5 + 0.01 * random_unit(x, y, 1), {float(random_unit(x, y, 2)), 0.5f, 0.2f, 1}}};
            if (x % 20 == 11 && y > 7)
                samples.insert(samples.begin(), Sample{depth_of(wide, c), {1000, 10, 1, 0.7f}});
            return samples;
        });
        expect_same(ldi, wide);
    }
}

// More channels than a group holds, and enough samples that a tile takes several passes.
TEST_F(SelectiveDeviceTest, ManyPartialSamplesOfAPixelAreTheCpus) {
    const Ldi ldi =
        make_ldi(windows_of_size(34, 12), {{"R"}, {"G"}, {"B"}, {"A"}, {"u"}, {"v"}}, [](int x, int y) {
            std::vector<Sample> samples;
            for (int i = 0; i < 24; ++i) {
                const float a = float(0.2 * random_unit(x, y, std::uint32_t(i)));
                const float b = a * float(random_unit(x, y, std::uint32_t(200 + i)));
                samples.push_back(
                    {depth_of(lens, -6 + 0.4 * i + 0.1 * random_unit(x, y, std::uint32_t(100 + i))),
                     {b, b / 2, a - b, a, b / 3, b * b}});
            }
            return samples;
        });
    expect_same(ldi, lens, 2);
}

TEST_F(SelectiveDeviceTest, StripesMakeTheSamePicture) {
    const Ldi ldi = random_surfaces(windows_of_size(50, 100), lens, false, 5);
    const Image expected = gather(ldi, lens, {});
    Watch small = watch();
    small.largest_buffer = 10 << 20;
    device = open_gather_device(*info, small);
    EXPECT_LE(largest_difference(gather(ldi, lens, {.device = device.get()}), expected),
              1e-6 * largest_of(expected));
    EXPECT_EQ(device->take_report().on_cpu, Tiles());
    expect_exceeds_buffers([&](TileDevice *used) { return gather(ldi, lens, {.device = used}); }, expected);
}

TEST_F(SelectiveDeviceTest, WhatTakesLongTakesPasses) {
    Watch few = watch();
    few.most_turns = 15000;
    device = open_gather_device(*info, few);
    expect_same(random_surfaces(windows_of_size(40, 30), lens, false, 8), lens, 3);
}

TEST_F(SelectiveDeviceTest, WithoutNumbersOf64BitsAllIsTheCpus) {
    const Ldi ldi = random_surfaces(windows_of_size(40, 30), lens, false, 6);
    DeviceInfo without = *info;
    without.float64 = false;
    device = open_gather_device(without, watch());
    EXPECT_EQ(gather(ldi, lens, {.device = device.get()}).values, gather(ldi, lens, {}).values);
    const TileReport did = device->take_report();
    EXPECT_EQ(did.on_device, 0u);
    EXPECT_EQ(did.on_cpu, (Tiles{{"the device has no numbers of 64 bits", 2}}));
}

TEST_F(SelectiveDeviceTest, AFailureLosesNothing) {
    const Ldi ldi = random_surfaces(windows_of_size(30, 20), lens, false, 7);
    const auto by = [&](TileDevice *used) { return gather(ldi, lens, {.device = used}); };
    const Image expected = by(nullptr);
    expect_bears_failures(by, expected, 1e-6 * largest_of(expected));
}

TEST_F(SelectiveDeviceTest, LittleMemoryIsEnough) {
    const Ldi ldi = random_surfaces(windows_of_size(300, 290), lens, false, 9);
    const auto by = [&](TileDevice *used) { return gather(ldi, lens, {40, used}); };
    const Image expected = by(nullptr);
    expect_needs_little_memory(by, expected, 1e-6 * largest_of(expected));
}

} // namespace
} // namespace sparselens::gpu
