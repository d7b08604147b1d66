// The devices that Vulkan gives access to, and which of them a word on a command line selects.
//
// The Vulkan loader (libvulkan.so.1) is opened when the devices are first asked for. Without a loader there are no
// devices, and everything else works as usual.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens::gpu {

// shared: a part of a GPU, as clouds lend it.
enum class Kind { discrete, integrated, shared, software, other };

struct DeviceInfo {
    std::string name;
    Kind kind = Kind::other;
    std::string lacks = {}; // what the kernels need and it lacks; empty: it can be used
    std::size_t index = 0;  // as Vulkan counts them
    bool float64 = false;   // computes with numbers of 64 bits, which the selective gather needs
};

// The devices of this machine; empty if no loader or no driver works. This does not throw; `why_none` says what Vulkan
// did.
std::vector<DeviceInfo> list_devices(std::string *why_none = nullptr);

inline constexpr const char *no_devices = "Vulkan gives access to no device here";

// Whether the kernel of the operating system has a GPU at all; costs nothing, unlike list_devices().
bool may_have_gpu();

// The device that a word selects among the devices that exist; none: the CPU.
// - cpu: none. auto: a GPU that can be used, discrete before integrated before shared; none if there is no such GPU.
// - gpu: the same, but throws Error, which names the existing devices, if there is no such GPU.
// - else a part of a name, in any case: that device, which may be in software. Throws Error if no name contains it.
std::optional<DeviceInfo> choose_device(std::string_view word, std::span<const DeviceInfo> there);

// "NVIDIA H100 (discrete GPU)"; what it lacks is named too.
std::string description(const DeviceInfo &device);

} // namespace sparselens::gpu
