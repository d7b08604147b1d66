// The connection to Vulkan, and what it says of its devices.
#pragma once

#include "gpu/device_list.h"
#include "gpu/vulkan.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace sparselens::gpu {

struct VulkanInstance {
    vk::raii::Context loader;
    vk::raii::Instance instance;
    std::optional<vk::raii::DebugUtilsMessengerEXT> messenger;

    // `message`: where given, the validation layer watches every call and says here what it finds; the layer must be
    // installed. Throws what Vulkan throws; std::runtime_error without a loader.
    explicit VulkanInstance(const std::function<void(const std::string &)> *message = nullptr);
};

// What a device is, and what of what the kernels need it lacks.
DeviceInfo info_of(const vk::raii::PhysicalDevice &device, std::size_t index);

} // namespace sparselens::gpu
