// Vulkan as src/gpu uses it: the loader is opened at run time, and every object ends with its C++ owner.
#pragma once

#define VK_NO_PROTOTYPES
#define VULKAN_HPP_DISPATCH_LOADER_DYNAMIC 1
#include <vulkan/vulkan_raii.hpp>

#include <cstdint>

namespace sparselens::gpu {

inline constexpr std::uint32_t vulkan_version = VK_API_VERSION_1_2; // shared 64-bit atomics belong to it

} // namespace sparselens::gpu
