// The Vulkan parts of a Device, its buffers and its programs.
#pragma once

#include "gpu/device.h"
#include "gpu/vulkan_instance.h"

#include <initializer_list>
#include <memory>
#include <optional>

namespace sparselens::gpu {

struct Buffer::Memory {
    vk::raii::DeviceMemory memory;
    vk::raii::Buffer buffer;
};

struct Program::Pipeline {
    std::uint32_t buffers, push_bytes;
    vk::raii::DescriptorSetLayout set_layout;
    vk::raii::PipelineLayout layout;
    vk::raii::Pipeline pipeline;
};

struct Device::Vulkan {
    VulkanInstance instance;
    vk::raii::PhysicalDevice physical;
    std::uint32_t family; // of queues that compute
    vk::raii::Device device;
    vk::raii::Queue queue;
    vk::raii::CommandPool commands;
    vk::PhysicalDeviceMemoryProperties memories;
    const Watch &watch;
    std::unique_ptr<Buffer::Memory> staging; // seen by host and device; made when it is first needed

    Vulkan(const DeviceInfo &info, const Watch &watch);

    void ask_watch() const; // throws the result that it gives for the next call
    // Allocates in the first kind of memory that has the best of these sets of properties.
    std::unique_ptr<Buffer::Memory> allocate(std::size_t bytes, vk::BufferUsageFlags usage,
                                             std::initializer_list<vk::MemoryPropertyFlags> best_first) const;
    const Buffer::Memory &staged();

    // Submits the commands that record(command buffer) records, and waits until they are done.
    template <typename Record>
    void submit(const Record &record) const {
        ask_watch();
        const vk::raii::CommandBuffers buffers(
            device, vk::CommandBufferAllocateInfo(*commands, vk::CommandBufferLevel::ePrimary, 1));
        const vk::raii::CommandBuffer &command = buffers.front();
        command.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
        record(command);
        command.end();
        const vk::raii::Fence done(device, vk::FenceCreateInfo());
        queue.submit(vk::SubmitInfo({}, {}, *command), *done);
        while (device.waitForFences(*done, true, ~std::uint64_t{0}) == vk::Result::eTimeout) {
        }
    }
};

// Runs `work`. Turns what Vulkan throws into DeviceFailed.
template <typename Work>
auto guarded(const DeviceInfo &info, const Work &work) {
    try {
        return work();
    } catch (const vk::DeviceLostError &) {
        throw DeviceFailed(info.name + " was lost");
    } catch (const vk::OutOfDeviceMemoryError &) {
        throw DeviceFailed(info.name + " has not enough memory");
    } catch (const vk::OutOfHostMemoryError &) {
        throw DeviceFailed(info.name + ": its driver found not enough memory");
    } catch (const std::exception &error) { // Vulkan's other errors, and a missing loader
        throw DeviceFailed(info.name + " failed (" + error.what() + ")");
    }
}

} // namespace sparselens::gpu
