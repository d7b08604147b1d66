#include "base/error.h"
#include "gpu/device_list.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

namespace sparselens::gpu {
namespace {

const DeviceInfo software{"llvmpipe (LLVM 15)", Kind::software, {}, 0},
    integrated{"Intel Iris", Kind::integrated, {}, 1}, discrete{"NVIDIA RTX", Kind::discrete, {}, 2},
    shared{"NVIDIA GRID", Kind::shared, {}, 3}, weak{"Old GPU", Kind::discrete, "64-bit integers", 4};

std::string chosen(std::string_view word, const std::vector<DeviceInfo> &there) {
    const auto device = choose_device(word, there);
    return device ? device->name : "CPU";
}

std::string refusal(std::string_view word, const std::vector<DeviceInfo> &there) {
    return what_of<Error>([&] { chosen(word, there); });
}

TEST(DeviceList, AutoTakesTheBestGpuAndNoneInSoftware) {
    EXPECT_EQ(chosen("auto", {software, integrated, shared, discrete}), "NVIDIA RTX");
    EXPECT_EQ(chosen("auto", {software, shared, integrated}), "Intel Iris");
    EXPECT_EQ(chosen("auto", {software, shared}), "NVIDIA GRID");
    EXPECT_EQ(chosen("auto", {weak, integrated}), "Intel Iris");
    EXPECT_EQ(chosen("auto", {software, weak}), "CPU");
    EXPECT_EQ(chosen("auto", {}), "CPU");
    EXPECT_EQ(chosen("cpu", {discrete}), "CPU");
}

TEST(DeviceList, GpuTakesTheSameOrSaysWhatThereIs) {
    EXPECT_EQ(chosen("gpu", {software, integrated, discrete}), "NVIDIA RTX");
    EXPECT_EQ(refusal("gpu", {software, weak}), "`device=gpu`: no GPU can be used; there is llvmpipe (LLVM "
                                                "15) (in software), Old GPU (discrete GPU, lacks "
                                                "64-bit integers). Use `device=cpu`");
    EXPECT_EQ(refusal("gpu", {}),
              "`device=gpu`: no GPU can be used; Vulkan gives access to no device here. Use `device=cpu`");
}

TEST(DeviceList, ANameIsAPartOfADevicesName) {
    EXPECT_EQ(chosen("LLVM", {discrete, software}), "llvmpipe (LLVM 15)");
    EXPECT_EQ(chosen("grid", {discrete, shared}), "NVIDIA GRID");
    EXPECT_EQ(refusal("radeon", {integrated}),
              "`device=radeon`: no device has that name; there is Intel Iris (integrated GPU)");
    EXPECT_EQ(refusal("old", {weak}),
              "`device=old`: Old GPU (discrete GPU, lacks 64-bit integers). Use `device=cpu`");
}

} // namespace
} // namespace sparselens::gpu
