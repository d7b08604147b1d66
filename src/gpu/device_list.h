// The devices that Vulkan gives access to, and which of them a word on a command line means.
//
// The Vulkan loader (libvulkan.so.1) is opened when the devices are asked for, and not before: where there is none, there
// are no devices, and everything else works as it does elsewhere.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens::gpu {

enum class Kind {
    discrete,
    integrated,
    shared,
    software,
    other
}; // shared: a part of a GPU, as clouds lend it

struct DeviceInfo {
    std::string name;
    Kind kind = Kind::other;
    std::string lacks = {}; // what the kernels need and it has not; empty: it can be used
    std::size_t index = 0;  // as Vulkan counts them
    bool float64 = false;   // computes with numbers of 64 bits, which the selective gather needs
};

// The devices of this machine; empty if no loader or no driver works. Does not throw for want of either, but says in
// `why_none` what Vulkan did.
std::vector<DeviceInfo> list_devices(std::string *why_none = nullptr);

inline constexpr const char *no_devices = "Vulkan gives access to no device here";

// Whether the kernel of the operating system has a GPU at all; costs nothing, unlike list_devices().
bool may_have_gpu();

// The device that a word means among those that are there; none: the CPU.
// - cpu: none. auto: a GPU that can be used, discrete before integrated before shared; none where there is none.
// - gpu: the same, but throws Error, which names the devices that there are, where there is none.
// - else a part of a name, in any case: that device, also one in software. Throws Error where none has it.
std::optional<DeviceInfo> choose_device(std::string_view word, std::span<const DeviceInfo> there);

// "NVIDIA H100 (discrete GPU)"; what it lacks is named too.
std::string description(const DeviceInfo &device);

} // namespace sparselens::gpu
