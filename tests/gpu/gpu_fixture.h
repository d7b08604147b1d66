// Uses the first device that works, even a software one; tests are skipped if there is none. If Vulkan's validation
// layer is not installed, a test that asks for it still runs, and then says that it ran without validation.
#pragma once

#include "base/image.h"
#include "base/progress.h"
#include "dof/device/tile_device.h"
#include "gpu/gather/gather_device.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sparselens::gpu {

class GpuTest : public testing::Test {
protected:
    void SetUp() override {
        for (const DeviceInfo &there : list_devices())
            if (there.lacks.empty() && !info) info = there;
        if (!info) GTEST_SKIP() << "Vulkan gives access to no device here that has what the kernels need";
    }
    // The validation layer must report nothing, also about leaked objects: the objects of derived fixtures are
    // destroyed by now.
    ~GpuTest() override { EXPECT_EQ(said, std::vector<std::string>()); }

    void TearDown() override {
        if (unwatched)
            GTEST_SKIP() << "it ran, but Vulkan's validation layer, which is to watch it, is not installed";
    }

    Watch watch() {
        if (!validates) return {};
        unwatched = !has_validation();
        if (unwatched) return {};
        return {.validation = [this](const std::string &text) { said.push_back(text); }};
    }

    // Works with a device that it opens, compares the result with the CPU's, and returns the device's report.
    using Work = std::function<DeviceReport()>;
    // Runs the work again and again: each time, Vulkan fails from a later call on.
    void expect_bears_failures(const Work &work);
    // Runs it on a device that has 64 MB of memory; the second expects that this is not enough, and says so.
    DeviceReport with_little_memory(const Work &work);
    void expect_exceeds_memory(const Work &work);

    std::optional<DeviceInfo> info;
    std::vector<std::string> said;

private:
    bool unwatched = false, validates = true;
};

// Compares pictures that a device gathers with the CPU's.
class TileDeviceTest : public GpuTest {
protected:
    using Tiles = std::map<std::string, std::size_t>;
    using Gather = std::function<Image(TileDevice *)>;

    // The pictures may differ by `tolerance`. The picture has one tile.
    void expect_bears_failures(const Gather &gather, const Image &expected, double tolerance);
    // The buffers of the device hold less than the picture needs, so the CPU gathers all of it.
    void expect_exceeds_buffers(const Gather &gather, const Image &expected);
    // The device has 64 MB of memory, which is too little for all tiles at once.
    void expect_needs_little_memory(const Gather &gather, const Image &expected, double tolerance);

    // The validation layer also reports objects that the device leaves behind.
    void TearDown() override {
        device.reset();
        GpuTest::TearDown();
    }

    std::unique_ptr<TileDevice> device;
};

} // namespace sparselens::gpu
