// Vulkan as src/gpu uses it: the loader is opened at run time, and every object ends with its C++ owner. This is the
// connection to Vulkan, and what Vulkan says about its devices.
#pragma once

#include "gpu/device_list.h"

#define VK_NO_PROTOTYPES
#define VULKAN_HPP_DISPATCH_LOADER_DYNAMIC 1
#include <vulkan/vulkan_raii.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace sparselens::gpu {

inline constexpr std::uint32_t vulkan_version = VK_API_VERSION_1_2;

struct VulkanInstance {
    vk::raii::Context loader;
    vk::raii::Instance instance;
    std::optional<vk::raii::DebugUtilsMessengerEXT> messenger;

    // `message`: if given, the validation layer watches every call and reports here what it finds; the layer must be
    // installed. Throws what Vulkan throws; std::runtime_error without a loader.
    explicit VulkanInstance(const std::function<void(const std::string &)> *message = nullptr);
};

// Describes a device, and the features of the kernels that it lacks.
DeviceInfo info_of(const vk::raii::PhysicalDevice &device, std::size_t index);

} // namespace sparselens::gpu
