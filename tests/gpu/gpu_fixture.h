// The first device that can be used, be it in software; tests are skipped where there is none.
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
    // The validation layer, where it is installed, has nothing to say.
    void TearDown() override { EXPECT_EQ(said, std::vector<std::string>()); }

    Watch watch() {
        if (!has_validation()) return {};
        return {.validation = [this](const std::string &text) { said.push_back(text); }};
    }

    std::optional<DeviceInfo> info;
    std::vector<std::string> said;
};

} // namespace sparselens::gpu
