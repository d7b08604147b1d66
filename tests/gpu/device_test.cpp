#include "gpu/gpu_fixture.h"

#include <cstring>
#include <numeric>

namespace sparselens::gpu {
namespace {

using DeviceTest = GpuTest;

TEST_F(DeviceTest, WhatIsUploadedIsDownloaded) {
    Device device(*info, watch());
    std::vector<std::uint32_t> numbers(5'000'000); // more than one copy holds
    std::iota(numbers.begin(), numbers.end(), 1u);
    Buffer buffer = device.buffer(numbers.size() * 4);
    device.upload(buffer, std::as_bytes(std::span(numbers)));
    std::vector<std::uint32_t> back(numbers.size());
    device.download(std::as_writable_bytes(std::span(back)), buffer);
    EXPECT_EQ(back, numbers);
    EXPECT_GE(device.largest_buffer(), std::size_t{1} << 27); // the minimum that Vulkan requires
}

TEST_F(DeviceTest, ADeviceThatIsNotThereFails) {
    DeviceInfo none = *info;
    none.index = 1000;
    EXPECT_THROW(Device{none}, DeviceFailed);
}

} // namespace
} // namespace sparselens::gpu
