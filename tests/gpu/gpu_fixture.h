// The first device that can be used, be it in software; tests are skipped where there is none. Where Vulkan's validation
// layer is not installed, a test that asks it to watch runs, and then says that nobody watched.
#pragma once

#include "gpu/device.h"

#include <gtest/gtest.h>

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
    // The validation layer has nothing to say, nor of what a device leaves behind: those of derived fixtures are gone.
    ~GpuTest() override { EXPECT_EQ(said, std::vector<std::string>()); }

    void TearDown() override {
        if (unwatched)
            GTEST_SKIP() << "it ran, but Vulkan's validation layer, which is to watch it, is not installed";
    }

    Watch watch() {
        unwatched = !has_validation();
        if (unwatched) return {};
        return {.validation = [this](const std::string &text) { said.push_back(text); }};
    }

    std::optional<DeviceInfo> info;
    std::vector<std::string> said;

private:
    bool unwatched = false;
};

} // namespace sparselens::gpu
