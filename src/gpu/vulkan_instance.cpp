#include "gpu/vulkan_instance.h"

#include "gpu/device.h"

#include <array>
#include <exception>
#include <string_view>

namespace sparselens::gpu {

namespace {

constexpr const char *validation_layer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL heard(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                     const VkDebugUtilsMessengerCallbackDataEXT *data, void *listener) {
    (*static_cast<const std::function<void(const std::string &)> *>(listener))(data->pMessage);
    return VK_FALSE;
}

vk::raii::Instance make_instance(const vk::raii::Context &loader, bool validate) {
    const vk::ApplicationInfo application("sparselens", 0, nullptr, 0, vulkan_version);
    vk::InstanceCreateInfo create({}, &application);
    const std::array<const char *, 1> extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    if (validate) create.setPEnabledLayerNames(validation_layer).setPEnabledExtensionNames(extensions);
    return {loader, create};
}

// Keeps the drivers loaded until the process ends. Each time NVIDIA's driver is loaded again, it takes memory of the
// threads (static TLS) that is not given back, so a process that opens devices again and again would lose it: on an
// H100, after about 40 times. It never ends, because a driver may end before static objects do.
void keep_drivers() {
    struct Drivers {
        vk::raii::Context loader;
        vk::raii::Instance instance = make_instance(loader, false);
    };
    [[maybe_unused]] static const auto *const kept = new Drivers;
}

Kind kind_of(vk::PhysicalDeviceType type) {
    switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu: return Kind::discrete;
    case vk::PhysicalDeviceType::eIntegratedGpu: return Kind::integrated;
    case vk::PhysicalDeviceType::eVirtualGpu: return Kind::shared;
    case vk::PhysicalDeviceType::eCpu: return Kind::software;
    default: return Kind::other;
    }
}

bool computes(const vk::raii::PhysicalDevice &device) {
    for (const vk::QueueFamilyProperties &family : device.getQueueFamilyProperties())
        if (family.queueFlags & vk::QueueFlagBits::eCompute) return true;
    return false;
}

std::string lacks(const vk::raii::PhysicalDevice &device, std::uint32_t version) {
    if (version < vulkan_version) return "Vulkan 1.2";
    if (!computes(device)) return "a queue that computes";
    return {};
}

} // namespace

VulkanInstance::VulkanInstance(const std::function<void(const std::string &)> *message)
    : instance(make_instance(loader, message != nullptr)) {
    keep_drivers();
    if (!message) return;
    // Uses the C structure, because the type of the callback has changed in Vulkan-Hpp's.
    VkDebugUtilsMessengerCreateInfoEXT create{};
    create.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    create.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    create.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    create.pfnUserCallback = heard;
    create.pUserData = const_cast<std::function<void(const std::string &)> *>(message);
    messenger.emplace(instance, vk::DebugUtilsMessengerCreateInfoEXT(create));
}

DeviceInfo info_of(const vk::raii::PhysicalDevice &device, std::size_t index) {
    const vk::PhysicalDeviceProperties properties = device.getProperties();
    return {properties.deviceName.data(), kind_of(properties.deviceType),
            lacks(device, properties.apiVersion), index, bool(device.getFeatures().shaderFloat64)};
}

bool has_validation() try {
    const vk::raii::Context loader;
    for (const vk::LayerProperties &layer : loader.enumerateInstanceLayerProperties())
        if (std::string_view(layer.layerName) == validation_layer) return true;
    return false;
} catch (const std::exception &) {
    return false; // no loader
}

std::vector<DeviceInfo> list_devices(std::string *why_none) try {
    const VulkanInstance vulkan;
    std::vector<DeviceInfo> devices;
    for (const vk::raii::PhysicalDevice &device : vk::raii::PhysicalDevices(vulkan.instance))
        devices.push_back(info_of(device, devices.size()));
    if (devices.empty() && why_none) *why_none = "its drivers know no device";
    return devices;
} catch (const std::exception &error) {
    if (why_none) *why_none = std::string(error.what()) + " (VK_LOADER_DEBUG=error says more)";
    return {};
}

} // namespace sparselens::gpu
