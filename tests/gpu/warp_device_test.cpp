// The kernels of the warp compared with the CPU.
#include "gpu/gpu_fixture.h"
#include "gpu/warp/warp_device.h"
#include "support/mattes.h"
#include "warp/warp_fixture.h"

#include <bit>
#include <map>
#include <memory>

namespace sparselens::gpu {
namespace {

using namespace warping;

using Rows = std::map<std::string, std::size_t>;

class WarpDeviceTest : public GpuTest {
protected:
    void open() {
        device.reset(); // only one device can be faulty at a time
        device = open_warp_device(*info, watch());
    }
    Ldi on_device(const std::vector<View> &views, WarpOptions options) {
        if (!device) open();
        options.device = device.get();
        return warped(views, options);
    }
    // The same bits; the device must have computed all rows.
    void expect_same(const std::vector<View> &views, const WarpOptions &options) {
        const Ldi expected = warped(views, options);
        expect_same_bits(on_device(views, options), expected);
        const DeviceReport did = device->take_report();
        EXPECT_EQ(did.on_device, std::size_t(expected.windows.height()));
        EXPECT_EQ(did.on_cpu, Rows());
        EXPECT_EQ(did.failure, "");
    }

    // The validation layer also reports objects that the device leaves behind.
    void TearDown() override {
        device.reset();
        GpuTest::TearDown();
    }

    std::unique_ptr<WarpDevice> device;
};

// Pixels where the views disagree, where they are apart, and where pixels become two samples.
TEST_F(WarpDeviceTest, RandomViewsAreTheCpus) {
    for (const int count : {1, 2, 5, 9}) {
        const std::vector<View> views = random_views(windows_of_size(50, 36), count);
        WarpOptions split = averaging, assumed = averaging;
        split.split_silhouettes = true;
        split.focus = 5;
        assumed.test_photo_consistency = false;
        for (const WarpOptions &options : {averaging, keeping, split, assumed}) expect_same(views, options);
    }
}

TEST_F(WarpDeviceTest, PlanesAreTheCpus) {
    for (const TwoPlanes &planes : {fence(), one_plane([](double x, double) { return float(x / 64); })}) {
        const std::vector<View> views = five_views(planes, windows_of_size(64, 48), radius);
        WarpOptions focused = averaging;
        for (const double focus : {2.0, 5.0, double(inf)}) {
            focused.focus = focus;
            expect_same(views, focused);
        }
        focused.across = 4; // so that blocks are searched for images
        expect_same(views, focused);
        expect_same(views, keeping);
    }
}

// Cameras in front of the centre view's or behind it, that zoom, or look past it.
TEST_F(WarpDeviceTest, FramingsAreTheCpus) {
    const Windows windows = windows_of_size(64, 48);
    const Framing framings[] = {{0.02, 1.03, {0.013, -0.021}}, {-0.05, 0.9, {}}, {1.5, 1, {}}};
    std::vector<View> views = random_views(windows, 1);
    for (const Framing &framing : framings) {
        views.push_back(fence().view(windows, {radius, 0.01}, framing));
        expect_same(views, averaging);
    }
}

// Some views were rendered in part, and one is cropped.
TEST_F(WarpDeviceTest, MissingViewsAreTheCpus) {
    std::vector<View> views = five_views(one_plane([](double x, double) { return float(x / 64); }),
                                         windows_of_size(64, 48), radius);
    for (std::size_t i = 0; i < views[1].z.size(); ++i)
        if (i % 64 < 30) views[1].image.plane(3)[i] = 0;
    View &cropped = views[2];
    const Imath::Box2i box({8, 10}, {50, 40});
    std::vector<float> depths;
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x)
            depths.push_back(cropped.z[cropped.image.windows.index(Imath::V2i(x, y))]);
    cropped.image = crop(cropped.image, box);
    cropped.z = depths;
    expect_same(views, averaging);
    expect_same(views, keeping);
}

// A software device cannot sort them all.
TEST_F(WarpDeviceTest, ManySamplesOfAPixelAreTheCpus) {
    const std::vector<View> views = random_views(windows_of_size(12, 10), 100);
    const Ldi expected = warped(views);
    expect_same_bits(on_device(views, averaging), expected);
    const DeviceReport did = device->take_report();
    EXPECT_EQ(did.on_cpu.contains("more samples in a pixel than it sorts"), info->kind == Kind::software);
}

// So near that 1 / z overflows its precise range, and so far that it vanishes. If a depth or 1 / z is denormal, which
// devices may take for 0, the CPU does everything.
TEST_F(WarpDeviceTest, ExtremeDepthsAreTheCpus) {
    std::vector<View> views = random_views(windows_of_size(36, 28), 4);
    const float depths[] = {1e-37f, 1e-9f, 0.5f, 3, 1e10f, 8e37f, inf};
    std::uint32_t i = 0;
    for (View &view : views)
        for (float &z : view.z) z = depths[(i++ * 2654435761u >> 16) % std::size(depths)];
    expect_same(views, averaging);
    expect_same(views, keeping);
    for (const float z : {1e-40f, 3e38f}) {
        views[1].z[5] = z;
        expect_same_bits(on_device(views, averaging), warped(views));
        EXPECT_EQ(device->take_report().on_device, 0u) << z;
    }
}

// Negative colours, and colours brighter than any light.
TEST_F(WarpDeviceTest, ExtremeColoursAreTheCpus) {
    std::vector<View> views = random_views(windows_of_size(36, 28), 4);
    const float colours[] = {0, -1, 1e-30f, 1, 65504, 3e38f};
    std::uint32_t i = 0;
    for (View &view : views)
        for (std::size_t k = 0; k < 3; ++k)
            for (float &value : view.image.plane(k))
                value = colours[(i++ * 2654435761u >> 16) % std::size(colours)];
    expect_same(views, averaging);
}

TEST_F(WarpDeviceTest, CryptomattesAreTheCpus) {
    std::vector<View> views = random_views(windows_of_size(30, 20), 3);
    for (View &view : views) {
        Image &image = view.image;
        image.channels = channels_with_matte();
        image.values.resize(image.windows.pixels() * image.channels.size(), 0.5f);
    }
    expect_same_bits(on_device(views, averaging), warped(views));
    EXPECT_GT(device->take_report().on_cpu.at("Cryptomattes"), 0u);
}

// Ids are copied, even if calculations would not preserve their bits as floats.
TEST_F(WarpDeviceTest, IdsAreTheCpus) {
    std::vector<View> views = random_views(windows_of_size(30, 20), 3);
    for (View &view : views) {
        Image &image = view.image;
        image.channels.push_back({"id", PixelType::uint32});
        for (std::size_t i = 0; i < image.windows.pixels(); ++i)
            image.values.push_back(std::bit_cast<float>(std::uint32_t(i % 7 + 1)));
    }
    expect_same(views, averaging);
    expect_same(views, keeping);
}

TEST_F(WarpDeviceTest, AFailureLosesNothing) {
    const std::vector<View> views = random_views(windows_of_size(20, 12), 2);
    const Ldi expected = warped(views);
    expect_bears_failures([&] {
        open();
        expect_same_bits(on_device(views, averaging), expected);
        const DeviceReport did = device->take_report();
        if (did.failure.empty()) return did;
        EXPECT_EQ(did.on_device + did.on_cpu.begin()->second, std::size_t(expected.windows.height()));
        on_device(views, averaging);
        EXPECT_EQ(device->take_report().on_device, 0u);
        return did;
    });
}

TEST_F(WarpDeviceTest, WhatExceedsItsMemoryIsTheCpus) {
    const std::vector<View> views = random_views(windows_of_size(500, 400), 5);
    expect_exceeds_memory([&] {
        open();
        expect_same_bits(on_device(views, averaging), warped(views));
        return device->take_report();
    });
}

TEST_F(WarpDeviceTest, NeedsDoublePrecision) {
    DeviceInfo without = *info;
    without.float64 = false;
    EXPECT_THROW(open_warp_device(without), DeviceFailed);
}

} // namespace
} // namespace sparselens::gpu
