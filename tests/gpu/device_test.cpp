#include "gpu/gpu_fixture.h"
#include "gpu/warp/prefix_sums.h"

#include <numeric>
#include <random>

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
    device.finish(std::array{Download{std::as_writable_bytes(std::span(back)), buffer}});
    EXPECT_EQ(back, numbers);
    EXPECT_GE(device.largest_buffer(), std::size_t{1} << 27); // the minimum that Vulkan requires
}

TEST_F(DeviceTest, PrefixSumsAreThoseOfTheCpu) {
    Device device(*info, watch());
    PrefixSums sums(device);
    std::minstd_rand random(1);
    for (const std::size_t count : {1u, 15u, 4096u, 4097u, 1'500'000u}) { // also more chunks than threads
        std::vector<std::uint32_t> numbers(count), expected(count), back(count);
        for (std::uint32_t &number : numbers) number = std::uint32_t(random() % 100);
        std::exclusive_scan(numbers.begin(), numbers.end(), expected.begin(), 0u);
        Buffer buffer = device.buffer(count * 4);
        device.upload(buffer, std::as_bytes(std::span(numbers)));
        sums.run(buffer, count);
        device.finish(std::array{Download{std::as_writable_bytes(std::span(back)), buffer}});
        EXPECT_EQ(back, expected) << count;
    }
}

TEST_F(DeviceTest, ADeviceThatIsNotThereFails) {
    DeviceInfo none = *info;
    none.index = 1000;
    EXPECT_THROW(Device{none}, DeviceFailed);
}

} // namespace
} // namespace sparselens::gpu
